// SPDX-License-Identifier: BSD-3-Clause
#include "display/viewport.h"

#include <algorithm>
#include <cmath>

namespace pimgview {

namespace {

/// Where the picture begins on one axis, rounded to whole screen pixels.
double place(double origin, double extent, double share, double size)
{
    return origin + std::round(extent / 2.0 - share * size);
}

}  // namespace

double Viewport::zoom(const LookOptions& look) const
{
    if (look.zoom > 0.0f)
        return double(look.zoom);
    return std::min({ double(width) / picture_width, double(height) / picture_height, 64.0 });
}

double Viewport::left(const LookOptions& look) const
{
    const double share = look.zoom > 0.0f ? double(look.x) : 0.5;
    return place(x, width, share, picture_width * zoom(look));
}

double Viewport::top(const LookOptions& look) const
{
    const double share = look.zoom > 0.0f ? double(look.y) : 0.5;
    return place(y, height, share, picture_height * zoom(look));
}

Region Viewport::visible(const LookOptions& look) const
{
    const double z = zoom(look), l = left(look), t = top(look);
    const auto clamped = [](double v, int most) {
        return int(std::clamp(v, 0.0, double(most)));
    };
    return { clamped(std::floor((x - l) / z), picture_width), clamped(std::floor((y - t) / z), picture_height),
             clamped(std::ceil((x + width - l) / z), picture_width),
             clamped(std::ceil((y + height - t) / z), picture_height) };
}

void Viewport::zoom_about(LookOptions& look, double factor, double at_x, double at_y) const
{
    const double before = zoom(look);
    const double px = (at_x - left(look)) / before, py = (at_y - top(look)) / before;
    const double fitting = std::min(double(width) / picture_width, double(height) / picture_height);
    const double after = std::clamp(before * factor, std::min({ fitting / 4.0, 0.25, before }), 64.0);
    look.zoom = float(after);
    look.x = float(std::clamp((x + width / 2.0 - at_x + px * after) / (picture_width * after), 0.0, 1.0));
    look.y = float(std::clamp((y + height / 2.0 - at_y + py * after) / (picture_height * after), 0.0, 1.0));
}

void Viewport::pan(LookOptions& look, double dx, double dy) const
{
    const double z = zoom(look);
    if (look.zoom <= 0.0f) {
        look.zoom = float(z);
        look.x = look.y = 0.5f;
    }
    look.x = float(std::clamp(double(look.x) - dx / (picture_width * z), 0.0, 1.0));
    look.y = float(std::clamp(double(look.y) - dy / (picture_height * z), 0.0, 1.0));
}

}  // namespace pimgview
