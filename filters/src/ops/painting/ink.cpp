// SPDX-License-Identifier: BSD-3-Clause
// Pen and ink (paper, section 7).
#include <pimg/imagebufalgo.h>

#include <algorithm>

#include <pimg/detail/format.h>
#include <pimg/ink.h>
#include <pimg/paint.h>

#include "frame/image_filter.h"
#include "ops/painting/painting.h"

namespace pimg {
namespace ImageBufAlgo {

namespace {

/// White paper with black lines.
bool draw(ProgressiveImage::Data& data, const InkOptions& options, const ParallelFor& parallel,
          std::vector<float>& paper, std::string& error)
{
    OwnedChannels eye;
    if (!check_strokes_name(options.strokes, error) || !eye_channels(data, parallel, eye, error))
        return false;
    const DirectionField field(eye.view(), parallel);
    PenOptions settings;
    settings.width = options.width;
    settings.length = options.length;
    settings.density = options.density;
    settings.outline = options.outline;
    settings.cross = options.cross;
    settings.seed = std::uint32_t(options.seed);
    Strokes lines;
    const Status status = plan_ink(data.hierarchy, darkness(data, eye).data(), field, settings, lines);
    error = status.error();
    if (!status || !write_strokes(options.strokes, lines, {}, 1.0f, "#ffffff", error))
        return false;
    paper.assign(data.hierarchy.mesh_pixels(), 1.0f);
    Canvas canvas { field.width(), field.height(), { paper.data() }, nullptr };
    StrokePaintOptions painting;
    painting.parallel = parallel;
    const std::vector<std::vector<float>> black(1, std::vector<float>(lines.strokes.size(), 0.0f));
    paint_strokes(lines, black, Brush::named("round"), painting, canvas);
    crop_to_picture(data.hierarchy, paper);
    return true;
}

}  // namespace

bool on_hierarchy::ink(ImageBuf& dst, const ProgressiveImage& src, const InkOptions& options, ROI roi, int nthreads)
{
    return run_filter(dst, options, [&] {
        if (!prepare(dst, src, roi, ResultType::as_source))
            return false;
        ProgressiveImage::Data& data = *src.data();
        const ParallelFor parallel = pool_loop(nthreads);
        std::vector<float> paper;
        std::string error;
        if (!draw(data, options, parallel, paper, error)) {
            set_error(dst, error);
            return false;
        }
        std::vector<std::vector<float>> results(std::size_t(data.colour.count()), paper);
        associate(data, results);
        write_channels(dst, data, roi, parallel, results, Specials::replaced);
        return true;
    });
}

}  // namespace ImageBufAlgo
}  // namespace pimg
