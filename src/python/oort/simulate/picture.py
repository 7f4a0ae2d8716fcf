# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""A picture of a simulated home with the way that the robot drove."""

from pathlib import Path

import numpy as np
from PIL import Image, ImageDraw

from oort.poses import Array
from oort.simulate.drive import Drive

SCALE = 120.0  # drawn pixels per metre, twice the picture's: it is scaled down for smooth edges
MARGIN = 0.4  # m
WALL = (60, 60, 64)
FLOOR = {"bathroom": (214, 230, 236), "kitchen": (240, 232, 212), "corridor": (232, 232, 228)}
OTHER_FLOOR = (245, 240, 232)
FURNITURE, FORBIDDEN = (172, 140, 104), (228, 214, 196)
OF_WALL = ("corner wall", "door leaf")
DOCK, PERSON = (30, 140, 60), (235, 150, 150)


def draw_home(drive: Drive, path: Path) -> None:
    """Write a PNG of the home in the map frame, x to the right: the true way runs from blue to red, the dock is green.

    Pale areas are furniture on legs, of which a scan sees the legs; pale red is where the person walked.
    """
    home = drive.home
    corners = np.vstack([room.corners for room in home.rooms])
    low, high = corners.min(axis=0) - MARGIN, corners.max(axis=0) + MARGIN
    size = np.ceil((high - low) * SCALE / 2.0).astype(int) * 2
    image = Image.new("RGB", (int(size[0]), int(size[1])), "white")
    draw = ImageDraw.Draw(image)

    def pixels(points: Array) -> list[tuple[float, float]]:
        return [((x - low[0]) * SCALE, (high[1] - y) * SCALE) for x, y in points.tolist()]

    def disc(x: float, y: float, radius: float, colour: tuple[int, int, int]) -> None:
        (left, top), (right, bottom) = pixels(np.array([[x - radius, y + radius], [x + radius, y - radius]]))
        draw.ellipse((left, top, right, bottom), fill=colour)

    for room in home.rooms:
        outline = pixels(np.vstack([room.corners, room.corners[:2]]))
        draw.line(outline, fill=WALL, width=int(0.24 * SCALE), joint="curve")
    for room in home.rooms:
        draw.polygon(pixels(room.corners), fill=FLOOR.get(room.kind, OTHER_FLOOR))
    for doorway in home.doorways:
        draw.polygon(pixels(doorway), fill=OTHER_FLOOR)
    for segment in home.segments.reshape(-1, 2, 2):
        draw.line(pixels(segment), fill=WALL, width=4)
    for piece in home.pieces:
        if not piece.solids:
            draw.polygon(pixels(piece.footprint), fill=FORBIDDEN)
        colour = WALL if piece.name in OF_WALL else DOCK if piece.name == "dock" else FURNITURE
        for solid in piece.solids:
            draw.polygon(pixels(solid), fill=colour)
        for x, y, radius in piece.discs.tolist():
            disc(x, y, radius, WALL)
    for x, y in drive.legs[~np.isnan(drive.legs[:, 0, 0])].reshape(-1, 2).tolist():
        disc(x, y, 0.02, PERSON)
    way = drive.T_map_base[:, :2]
    for i in range(len(way) - 1):
        share = i / len(way)
        draw.line(pixels(way[i : i + 2]), fill=(int(255 * share), 60, int(255 * (1.0 - share))), width=4)
    image.resize((image.width // 2, image.height // 2), Image.Resampling.BOX).save(path, format="PNG")
