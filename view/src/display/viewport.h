// SPDX-License-Identifier: BSD-3-Clause
// Where the picture lies on the screen.
#pragma once

#include "render/frame.h"
#include "state/look.h"

namespace pimgview {

/// The part of the frame buffer that pictures are shown in, from the upper left corner.
struct Viewport {
    int x = 0, y = 0, width = 1, height = 1;
    int picture_width = 1, picture_height = 1;

    /// Screen pixels to a pixel of the picture: as the look has it, or so that the picture fits.
    double zoom(const LookOptions& look) const;

    /// Screen place of the picture's upper left corner, in whole pixels, so that pixels fall on pixels.
    double left(const LookOptions& look) const;
    double top(const LookOptions& look) const;

    /// Pixels of the picture that are in view.
    Region visible(const LookOptions& look) const;

    /// Changes the zoom by a factor; the place under the pointer stays where it is.
    void zoom_about(LookOptions& look, double factor, double at_x, double at_y) const;

    /// Moves the picture by screen pixels.
    void pan(LookOptions& look, double dx, double dy) const;

    bool contains(double at_x, double at_y) const
    {
        return at_x >= x && at_y >= y && at_x < x + width && at_y < y + height;
    }
};

}  // namespace pimgview
