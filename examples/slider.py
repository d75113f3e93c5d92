#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Retunes a filter while you drag: slider.py PICTURE [FILTER]

The hierarchy is built once; each move of a slider costs one sweep. Sliders come from the filter's own option table.
Needs Matplotlib (Debian: python3-matplotlib)."""

import sys
import time

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.widgets import Button, Slider

import pimg

SLIDERS = 6  # the first so many options that are numbers


class Tuner:
    """A window with a picture and a slider for every option."""

    def __init__(self, progressive, name="hdr_compress"):
        self.filter = getattr(progressive, name)
        self.options = [row for row in pimg.options(name) if row["type"] in ("int", "float")][:SLIDERS]
        found = progressive.resolve_hdr_compress() if name == "hdr_compress" else {}
        self.linear = name == "hdr_compress" or progressive.guide == "log"
        self.figure = plt.figure(figsize=(8, 7))
        self.sliders = {row["name"]: self.slider(i, row, found) for i, row in enumerate(self.options)}
        self.reset = Button(self.figure.add_axes([0.8, 0.01, 0.15, 0.04]), "reset")
        self.reset.on_clicked(lambda event: [slider.reset() for slider in self.sliders.values()])
        axes = self.figure.add_axes([0.02, 0.38, 0.96, 0.58])
        axes.set_axis_off()
        self.image = axes.imshow(self.render(), cmap="gray", vmin=0, vmax=1)
        self.title = axes.set_title("")

    def slider(self, i, row, found):
        start = found.get(row["name"], row["default"])
        start = row["min"] if start is None else start
        low = row["min"] if row["min"] is not None else 0
        high = min(row["max"] or np.inf, max(4 * abs(start), 1))
        axes = self.figure.add_axes([0.2, 0.31 - 0.05 * i, 0.6, 0.03])
        slider = Slider(axes, row["name"], low, high, valinit=start, valstep=1 if row["type"] == "int" else None)
        slider.on_changed(self.update)
        return slider

    def render(self):
        """With the options whose sliders have been moved."""
        moved = {name: slider.val for name, slider in self.sliders.items() if slider.val != slider.valinit}
        result = self.filter(**moved)
        if self.linear:
            result = pimg.srgb_encoded(result)
        if result.dtype.kind == "u":
            result = result / np.iinfo(result.dtype).max
        return np.clip(result if result.ndim == 2 else result[..., :3], 0, 1)

    def update(self, value):
        start = time.perf_counter()
        self.image.set_data(self.render())
        self.title.set_text(f"{1000 * (time.perf_counter() - start):.0f} ms")
        self.figure.canvas.draw_idle()


if __name__ == "__main__":
    if len(sys.argv) not in (2, 3):
        sys.exit(__doc__)
    tuner = Tuner(pimg.open(sys.argv[1], array=True), *sys.argv[2:])
    plt.show()
