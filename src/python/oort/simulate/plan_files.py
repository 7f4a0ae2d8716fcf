# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Opens floor plans of all kinds."""

import os
from dataclasses import replace
from pathlib import Path

from oort.errors import InputError
from oort.recording.types import Pose
from oort.simulate.plan import Plan
from oort.simulate.plan_image import read_plan_image
from oort.simulate.procthor import read_procthor


def read_plan(
    path: str | os.PathLike[str],
    resolution: float | None = None,
    dock: Pose | None = None,
    assets: str | os.PathLike[str] | None = None,
) -> Plan:
    """A floor plan from a picture (PNG, PGM ...), a map of map_server (.yaml), or JSON as ProcTHOR has it (.json).

    ``resolution`` is the side of a picture's pixel [m], ``dock`` the pose of the docked base in the plan's frame,
    ``assets`` ProcTHOR's asset-database.json, which has the sizes of a house's objects.
    Raises InputError for what cannot be read, and without shapely and scipy.
    """
    path = Path(path)
    try:
        import scipy  # noqa: F401
        import shapely  # noqa: F401
    except ImportError:
        raise InputError('floor plans need shapely and scipy: pip install "oort[export]"') from None
    if path.suffix.lower() != ".json":
        if assets is not None:
            raise InputError(f"{path} has no objects; leave out --assets")
        return replace(read_plan_image(path, resolution), dock=dock)
    if resolution is not None:
        raise InputError(f"{path} is in metres; leave out --resolution")
    return replace(read_procthor(path, None if assets is None else Path(assets)), dock=dock)
