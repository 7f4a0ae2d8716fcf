# SPDX-FileCopyrightText: 2026 The Oort authors
# SPDX-License-Identifier: Apache-2.0
"""Pictures of histograms."""

from pathlib import Path

from PIL import Image

from oort.export.chart import Panel, write_chart

BLUE = (40, 90, 200)


def test_more_bins_than_pixels_are_drawn(tmp_path: Path) -> None:
    days = [float(day) for day in range(1000)]
    write_chart(tmp_path / "days.png", [Panel("days", days, [1.0] * 1000)])
    with Image.open(tmp_path / "days.png") as picture:
        pixels = picture.convert("RGB")
        row = [pixels.getpixel((x, pixels.height - 40)) for x in range(pixels.width)]
    assert row.count(BLUE) > 0.85 * len(row)
