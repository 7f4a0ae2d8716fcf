# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""The list of what is wrong with a drive, from its scans and from what mapping has learned."""

import math
from collections.abc import Mapping
from typing import Any

import numpy as np

from oort.diagnosis.motion import motion_troubles, scales_of
from oort.diagnosis.observer import Observer
from oort.diagnosis.trouble import Trouble

_UNCERTAIN = 0.5  # share of scans
_FEW = 50  # scans, of which no share says much
_SCALE = 0.08  # of odometry; what is learned of it ends at 0.1
_REPEATED = 3  # scans that are worth telling
_GAP = 2.0  # [s] and
_GAP_FACTOR = 10.0  # times the usual interval
_GAP_TRAVEL, _GAP_TURN = 0.5, 1.0  # [m], [rad] meanwhile; a robot that stands may be silent


def diagnose(observer: Observer, statistics: Mapping[str, Any]) -> list[Trouble]:
    """What is wrong, the causes first; ``statistics`` are the mapper's."""
    causes = motion_troubles(observer)
    if not causes:  # else these are its consequences
        causes = [
            *_odometry_scale(observer, statistics["odometry_scale"]),
            *_odometry_faults(observer, statistics["odometry_faults"]),
        ]
    return [*causes, *_laser(statistics["laser"]), *_gaps(observer), *_uncertain(statistics["tracking"])]


def _odometry_scale(observer: Observer, scale: Mapping[str, float]) -> list[Trouble]:
    """What mapping has learned, if the pairs of scans say the same: a narrow view alone learns what is not there."""
    seen = dict(zip(("translation", "rotation"), scales_of(observer), strict=True))
    return [
        Trouble(
            f"odometry_{what}_scale",
            f"the robot {verb} {scale[what]:.2f} times as far as odometry says; mapped so",
            f"calibrate the base: {advice}",
            {"scale": scale[what]},
        )
        for what, verb, advice in (
            ("translation", "drives", "the wheels' radius or the ticks per turn"),
            ("rotation", "turns", "the distance of the wheels, or the gyro's scale"),
        )
        if abs(scale[what] - 1.0) >= _SCALE and (seen[what] - 1.0) * (scale[what] - 1.0) >= 0.5 * _SCALE**2
    ]


def _odometry_faults(observer: Observer, faults: Mapping[str, Any]) -> list[Trouble]:
    begin = observer.stamps[0] if observer.stamps else 0.0
    found = []
    for kind, what, advice in (
        (
            "freeze",
            "odometry stands still while the robot moves",
            "check the base's driver and the load of its machine",
        ),
        (
            "jump",
            "odometry moves farther than a robot can",
            "look for a base driver that restarts, two programs that publish odometry, or a pose that is corrected",
        ),
        (
            "reversed",
            "odometry goes ahead while the robot drives backwards",
            "give the base's driver encoders, or motor commands, that tell the sense of rotation",
        ),
    ):
        those = [fault for fault in faults["first"] if fault["kind"] == kind]
        if not those:
            continue
        worst = max(those, key=lambda fault: fault["distance"] + fault["angle"])
        found.append(
            Trouble(
                f"odometry_{kind}",
                f"{what}, {_times(len(those))}, at worst by {worst['distance']:.2f} m and "
                f"{math.degrees(worst['angle']):.0f} degrees {worst['time'] - begin:.1f} s after the first scan",
                advice,
                {"times": len(those), "distance_m": worst["distance"], "angle_rad": worst["angle"]},
            )
        )
    return found


def _laser(laser: Mapping[str, Any]) -> list[Trouble]:
    found = []
    order = laser["beam_order"]
    if order["decided"] and order["order"] != "stamped":
        costs = order["costs"]
        told = {"reversed": "the last beam first", "at_once": "all at once"}[order["order"]]
        found.append(
            Trouble(
                "beam_order",
                f"the laser's beams are measured {told}, not as time_increment says; mapped so",
                "correct the driver: of a clockwise laser whose beams are turned round, time_increment is negative and "
                "the stamp that of the last beam",
                {"tests": order["tests"], "cost_as_stamped": costs["stamped"], "cost": costs[order["order"]]},
            )
        )
    if laser["repeated_scans"] >= _REPEATED:
        found.append(
            Trouble(
                "scan_repeated",
                f"the laser's readings are those of the scan before though the robot moves, "
                f"{_times(laser['repeated_scans'])}; left out",
                "look for a driver or a bridge that sends its last scan again when no new one comes",
                {"times": laser["repeated_scans"]},
            )
        )
    if laser["body"]:
        sectors = ", ".join(
            f"{math.degrees(begin):.0f} to {math.degrees(end):.0f} degrees" for begin, end, _ in laser["body"]
        )
        found.append(
            Trouble(
                "body_in_view",
                f"the laser sees the robot itself at {sectors}; left out",
                "mount it freely, or leave these beams out from the first scan on: "
                + " ".join(f"--mask {begin:.3f} {end:.3f}" for begin, end, _ in laser["body"]),
                {"sectors": len(laser["body"]), "width_rad": sum(end - begin for begin, end, _ in laser["body"])},
            )
        )
    return found


def _gaps(observer: Observer) -> list[Trouble]:
    stamps, poses = np.array(observer.stamps), np.array(observer.odometry)
    if len(stamps) < _FEW:
        return []
    steps, moved = np.diff(stamps), np.diff(poses, axis=0)
    wanted = ~np.isin(stamps[1:], list(observer.after_pauses))
    long = wanted & (steps > max(_GAP, _GAP_FACTOR * float(np.median(steps))))
    far = (np.hypot(moved[:, 0], moved[:, 1]) > _GAP_TRAVEL) | (np.abs(moved[:, 2]) > _GAP_TURN)
    gaps = np.flatnonzero(long & far)
    if not len(gaps):
        return []
    worst = gaps[np.argmax(steps[gaps])]
    return [
        Trouble(
            "scan_gap",
            f"no scan comes for up to {steps[worst]:.1f} s while the robot drives, {_times(len(gaps))}, the longest "
            f"{stamps[worst] - stamps[0]:.1f} s after the first scan",
            "check the laser's cable and driver, and that the recorder keeps up",
            {"times": len(gaps), "longest_s": float(steps[worst])},
        )
    ]


def _uncertain(tracking: Mapping[str, int]) -> list[Trouble]:
    scans = tracking["tracking"] + tracking["uncertain"] + tracking["lost"]
    share = (tracking["uncertain"] + tracking["lost"]) / max(scans, 1)
    if scans < _FEW or share <= _UNCERTAIN:
        return []
    return [
        Trouble(
            "uncertain",
            f"where the robot was is uncertain for {share:.0%} of the scans, so the map is not to be relied on",
            "look at what is listed above it, else at the laser's range and view",
            {"share": share, "scans": scans},
        )
    ]


def _times(count: int) -> str:
    return "once" if count == 1 else f"{count} times"
