# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""GeoJSON in the map's plain metres."""

import json
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from oort.export.files import write_atomically


def write_geojson(path: Path, features: Sequence[dict[str, Any]], name: str) -> None:
    """Writes a FeatureCollection in the map's plain metres. Raises OortError if the file cannot be written."""
    collection = {"type": "FeatureCollection", "name": name, "features": list(features)}
    write_atomically(path, (json.dumps(collection, indent=1) + "\n").encode())


def feature(properties: dict[str, Any], kind: str, coordinates: Any) -> dict[str, Any]:
    """A GeoJSON feature."""
    return {"type": "Feature", "properties": properties, "geometry": {"type": kind, "coordinates": coordinates}}
