// SPDX-License-Identifier: BSD-3-Clause
// A picture with what painting needs of it, for the tests of painting.
#pragma once

#include <type_traits>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <pimg/paint.h>
#include <pimg/simplify.h>

#include "core/pictures.h"

namespace pimg::test {

/// The channels of a picture as painting takes them.
using View = std::remove_cv_t<std::remove_pointer_t<decltype(StrokePaintOptions::edges)>>;

inline View view_of(const Picture& p)
{
    return { p.width, p.height, { p.samples.data() } };
}

struct PaintedScene {
    Picture picture;
    Hierarchy hierarchy;
    View guides;  ///< one channel, of the mesh's size
    std::vector<float> samples;

    explicit PaintedScene(Picture p) : picture(std::move(p))
    {
        Guide guide;
        guide.width = picture.width;
        guide.height = picture.height;
        guide.channels.resize(1);
        guide.channels[0].samples = picture.samples.data();
        std::vector<Bands> bands;
        const Status status = simplify(guide, {}, hierarchy, bands);
        EXPECT_TRUE(status.ok()) << status.error();
        samples = to_mesh_pixels(hierarchy, picture.samples.data());
        guides = { hierarchy.mesh_width(), hierarchy.mesh_height(), { samples.data() } };
    }
    PaintedScene(const PaintedScene&) = delete;

    Strokes strokes(const StrokeOptions& options) const
    {
        const DirectionField field(guides, options.parallel);
        Strokes planned;
        EXPECT_TRUE(plan_strokes(hierarchy, guides, field, options, planned).ok());
        return planned;
    }
};

/// Runs the bodies last to first, as no loop would.
inline void backwards(std::size_t n, const std::function<void(std::size_t)>& body)
{
    for (std::size_t i = n; i-- > 0;)
        body(i);
}

}  // namespace pimg::test
