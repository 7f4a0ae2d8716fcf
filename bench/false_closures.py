# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""False closures for pose graphs, of the four kinds that Suenderhauf and Protzel tested with (2012)."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from oort.export.g2o import PoseGraph

Floats = NDArray[np.float64]

KINDS = ("random", "local", "grouped", "locally grouped")

GROUP = 20
"""Closures in a group: they link this many nodes in a row with as many in a row elsewhere."""
NEAR = 20
"""A local closure's ends are at most this many nodes apart."""
CLAIM_SIGMA = np.array([0.3, 0.3, np.radians(10.0)])
"""A false closure says that its ends are at the same place, give or take this [m, m, rad]."""
CONTRADICTED = 11.345
"""A claim is false if its squared Mahalanobis distance from the truth is above this: 99 % of a chi-square of 3."""
AGREED = 7.815
"""Neighbours in a group agree with each other if theirs is at most this: 95 %."""


class SpoiltGraph(NamedTuple):
    """A pose graph and what is false in it."""

    graph: PoseGraph
    """The true edges, and after them the false ones, each with the covariance of the graph's first closure."""
    false: NDArray[np.bool_]
    """(m,)"""
    group: NDArray[np.int64]
    """(m,) the number of a false closure's group, from 0; -1 for others"""


def add_false_closures(graph: PoseGraph, truth: Floats, kind: str, count: int, seed: int) -> SpoiltGraph:
    """Adds `count` false closures of one kind; the same arguments give the same graph.

    A claim that the true poses (n, 3) agree with by accident is not false: it is drawn anew, wider each time.
    """
    random = np.random.Generator(np.random.PCG64([seed, KINDS.index(kind), count]))
    pairs = draw_pairs(len(graph.poses), kind, count, random)
    covariance = graph.covariances[np.argmax(is_closure(graph))]
    information = np.linalg.inv(covariance)
    claims = CLAIM_SIGMA * random.standard_normal((count, 3))
    true_claims = relative(truth[pairs[:, 0]], truth[pairs[:, 1]])
    width = 1.0
    while len(agreeing := np.flatnonzero(squared_distance(claims, true_claims, information) <= CONTRADICTED)):
        width *= 1.5
        claims[agreeing] = width * CLAIM_SIGMA * random.standard_normal((len(agreeing), 3))
    spoilt = PoseGraph(
        ids=graph.ids,
        poses=graph.poses,
        edges=np.concatenate([graph.edges, pairs]),
        measurements=np.concatenate([graph.measurements, claims]),
        covariances=np.concatenate([graph.covariances, np.repeat(covariance[None], count, axis=0)]),
    )
    genuine = len(graph.edges)
    group = np.full(genuine + count, -1)
    if "grouped" in kind:
        group[genuine:] = np.arange(count) // GROUP
    return SpoiltGraph(spoilt, np.arange(genuine + count) >= genuine, group)


def draw_pairs(nodes: int, kind: str, count: int, random: np.random.Generator) -> NDArray[np.int64]:
    """(count, 2) nodes that false closures of this kind link."""
    size = GROUP if "grouped" in kind else 1
    starts = -(-count // size)
    if kind in ("local", "locally grouped"):
        i = random.integers(nodes - NEAR - size, size=starts)
        j = i + random.integers(2, NEAR + 1, size=starts)
    else:
        i = random.integers(nodes - size - 2, size=starts)
        j = random.integers(i + 2, nodes - size + 1)
    steps = np.arange(size)
    return np.stack([i[:, None] + steps, j[:, None] + steps], axis=2).reshape(-1, 2)[:count]


def count_agreeing_groups(spoilt: SpoiltGraph, truth: Floats) -> int:
    """How many groups agree with each other: most neighbours in them do, given the true steps between their ends."""
    agreeing = 0
    covariance = spoilt.graph.covariances[-1]
    information = np.linalg.inv(2.0 * covariance)
    for group in range(spoilt.group.max() + 1):
        members = np.flatnonzero(spoilt.group == group)
        i, j = spoilt.graph.edges[members].T
        claims = spoilt.graph.measurements[members]
        there = compose(claims[:-1], relative(truth[j[:-1]], truth[j[1:]]))
        expected = compose(relative(truth[i[1:]], truth[i[:-1]]), there)
        agreeing += bool(np.mean(squared_distance(claims[1:], expected, information) <= AGREED) > 0.5)
    return agreeing


def is_closure(graph: PoseGraph) -> NDArray[np.bool_]:
    """(m,) whether an edge is none of the chain's."""
    return np.asarray(np.abs(graph.edges[:, 1] - graph.edges[:, 0]) != 1)


def wrap(angle: Floats) -> Floats:
    """Angles in [-pi, pi)."""
    return np.asarray(np.remainder(angle + np.pi, 2.0 * np.pi) - np.pi)


def relative(a: Floats, b: Floats) -> Floats:
    """T_a_b (n, 3), row by row."""
    c, s = np.cos(a[:, 2]), np.sin(a[:, 2])
    dx, dy = (b - a)[:, :2].T
    return np.stack([c * dx + s * dy, c * dy - s * dx, wrap(b[:, 2] - a[:, 2])], axis=1)


def compose(a: Floats, b: Floats) -> Floats:
    """T_x_z = T_x_y T_y_z (n, 3), row by row."""
    c, s = np.cos(a[:, 2]), np.sin(a[:, 2])
    x, y, theta = b.T
    return np.stack([a[:, 0] + c * x - s * y, a[:, 1] + s * x + c * y, wrap(a[:, 2] + theta)], axis=1)


def squared_distance(a: Floats, b: Floats, information: Floats) -> Floats:
    """(n,) e^T information e with e = a - b, headings wrapped; information (3, 3) or (n, 3, 3)."""
    error = a - b
    error[:, 2] = wrap(error[:, 2])
    return np.asarray(np.einsum("...i,...ij,...j->...", error, information, error))
