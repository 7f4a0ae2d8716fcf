# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""How much of a log's error is the truth's own: do two trajectories err alike?

    oort replay LOG --out A
    oort replay LOG --out B --params params/cartographer.json
    .venv/bin/python bench/agreement.py A/trajectory.tum B/trajectory.tum LOG.relations

Two front ends with different matchers make different mistakes. What both are off by, at the same relations and the same
way, is either in the scans or in the relations; no mapping of these scans takes it out.
"""

import argparse

import numpy as np
from numpy.typing import NDArray

from oort.evaluation.trajectories import evaluate_relations, relation_errors
from oort.export.tum import read_tum


def _lengths(errors: NDArray[np.float64]) -> NDArray[np.float64]:
    return np.hypot(errors[:, 0], errors[:, 1])


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("trajectories", nargs=2, metavar="TRAJ", help="of the robot's base, in the TUM format")
    parser.add_argument("relations", metavar="FILE", help="lines t1 t2 x y z roll pitch yaw")
    arguments = parser.parse_args()
    trajectories = [read_tum(path) for path in arguments.trajectories]
    a, b = (relation_errors(trajectory, arguments.relations) for trajectory in trajectories)
    both = np.isfinite(a[:, 0]) & np.isfinite(b[:, 0])
    a, b = a[both], b[both]
    for path, trajectory in zip(arguments.trajectories, trajectories, strict=True):
        print(f"{path}: mean error {evaluate_relations(trajectory, arguments.relations).translation_mean:.4f} m")
    correlations = [float(np.corrcoef(a[:, k], b[:, k])[0, 1]) for k in range(3)]
    print("correlation of the errors: x {:.3f}  y {:.3f}  theta {:.3f}".format(*correlations))
    print(f"mean difference between the two: {_lengths(a - b).mean():.4f} m")
    print(f"mean error of their average: {_lengths((a + b) / 2.0).mean():.4f} m")


if __name__ == "__main__":
    main()
