// SPDX-License-Identifier: BSD-3-Clause
#include "source/preview.h"

#include <algorithm>

#include <pimg/detail/parallel.h>

#include "source/guide.h"
#include "source/progressive_image_data.h"

namespace pimg {
inline namespace PIMG_ABI {

namespace {

constexpr int kMostPixels = 550000;  ///< of a preview: 1920 x 1080 is halved, 3840 x 2160 is quartered
constexpr int kLeastSide = 64;       ///< of a picture that is reduced

/// Variance of the guide, in squared guide units, beside which the usual slope counts as much as what the neighbourhood
/// tells: that of 3 % of luminance.
constexpr float kFlat = 1e-3f * kUnitsPerStop * kUnitsPerStop;

/// The slope of `result` over `guide` in the 3 x 3 pixels around each.
std::vector<float> slopes(const Raster& guide, const std::vector<float>& result, float usual,
                          const ParallelFor& parallel)
{
    std::vector<float> slope(guide.samples.size());
    for_rows(parallel, 0, guide.height, [&](int y) {
        const int y0 = std::max(y - 1, 0), y1 = std::min(y + 1, guide.height - 1);
        for (int x = 0; x < guide.width; ++x) {
            const int x0 = std::max(x - 1, 0), x1 = std::min(x + 1, guide.width - 1);
            const std::size_t centre = std::size_t(y) * std::size_t(guide.width) + std::size_t(x);
            float g = 0.0f, r = 0.0f, gg = 0.0f, gr = 0.0f;
            for (int v = y0; v <= y1; ++v)
                for (int u = x0; u <= x1; ++u) {
                    const std::size_t i = std::size_t(v) * std::size_t(guide.width) + std::size_t(u);
                    const float dg = guide.samples[i] - guide.samples[centre], dr = result[i] - result[centre];
                    g += dg;
                    r += dr;
                    gg += dg * dg;
                    gr += dg * dr;
                }
            const float n = float((y1 - y0 + 1) * (x1 - x0 + 1));
            slope[centre] = ((gr - g * r / n) / n + kFlat * usual) / (std::max(gg - g * g / n, 0.0f) / n + kFlat);
        }
    });
    return slope;
}

/// Where pixel `x` of the full picture lies between two pixels of the reduced one.
struct Between {
    int low, high;
    float share;  ///< of the higher
};

Between between(int x, int step, int size)
{
    const float at = (float(x) + 0.5f) / float(step) - 0.5f;
    const int low = std::max(int(at + 1.0f) - 1, 0);
    return { std::min(low, size - 1), std::min(low + 1, size - 1), std::clamp(at - float(low), 0.0f, 1.0f) };
}

}  // namespace

int preview_step(int width, int height)
{
    if (std::min(width, height) < kLeastSide)
        return 1;
    int step = 2;
    while (std::int64_t(width / step) * (height / step) > kMostPixels && std::min(width, height) / step > kLeastSide)
        step *= 2;
    return step;
}

Raster reduced(const Raster& picture, int step, const ParallelFor& parallel)
{
    Raster small { (picture.width + step - 1) / step, (picture.height + step - 1) / step, {} };
    small.samples.resize(std::size_t(small.width) * std::size_t(small.height));
    for_rows(parallel, 0, small.height, [&](int y) {
        float* const row = small.samples.data() + std::size_t(y) * std::size_t(small.width);
        const int y1 = std::min((y + 1) * step, picture.height);
        for (int v = y * step; v < y1; ++v) {
            const float* p = picture.samples.data() + std::size_t(v) * std::size_t(picture.width);
            for (int x = 0; x < picture.width; ++x)
                row[x / step] += p[x];
        }
        for (int x = 0; x < small.width; ++x)
            row[x] /= float((std::min((x + 1) * step, picture.width) - x * step) * (y1 - y * step));
    });
    return small;
}

void enlarge(const Raster& small_guide, const std::vector<float>& small_result, int step, const Raster& guide,
             float usual, const ParallelFor& parallel, std::vector<float>& result)
{
    const std::vector<float> slope = slopes(small_guide, small_result, usual, parallel);
    const int width = small_guide.width;
    std::vector<Between> across;
    for (int x = 0; x < guide.width; ++x)
        across.push_back(between(x, step, width));
    for_rows(parallel, 0, guide.height, [&](int y) {
        const Between down = between(y, step, small_guide.height);
        std::vector<float> row(3 * std::size_t(width));
        const float* const fields[] = { small_guide.samples.data(), small_result.data(), slope.data() };
        for (std::size_t f = 0; f < 3; ++f) {
            const float* const low = fields[f] + std::size_t(down.low) * std::size_t(width);
            const float* const high = fields[f] + std::size_t(down.high) * std::size_t(width);
            for (int x = 0; x < width; ++x)
                row[f * std::size_t(width) + std::size_t(x)] = low[x] + down.share * (high[x] - low[x]);
        }
        const float *const g = row.data(), *const r = g + width, *const s = r + width;
        const std::size_t first = std::size_t(y) * std::size_t(guide.width);
        for (int x = 0; x < guide.width; ++x) {
            const Between& b = across[std::size_t(x)];
            const auto at = [&](const float* field) {
                return field[b.low] + b.share * (field[b.high] - field[b.low]);
            };
            const std::size_t i = first + std::size_t(x);
            result[i] = at(r) + at(s) * (guide.samples[i] - at(g));
        }
    });
}

bool ProgressiveImage::Data::build_preview(const ParallelFor& parallel, const Progress& progress, std::string& error)
{
    specials = repair(source, colour, parallel);
    m_log = std::make_unique<LogBands>();
    m_log->luminance = log_luminance(source, colour, parallel);
    const LogLuminance& luminance = m_log->luminance;
    hierarchy.width = spec.width, hierarchy.height = spec.height;
    stats.guide = "log";

    step = preview_step(spec.width, spec.height);
    small = std::make_unique<Data>();
    small->options = options;
    small->options.weights.clear();
    small->stats.guide = "log";
    small->m_log = std::make_unique<LogBands>();
    small->m_log->luminance = {
        pimg::reduced(luminance.guide, step, parallel), luminance.reference, luminance.floor, {}
    };
    const Raster& guide = small->m_log->luminance.guide;
    small->spec.width = guide.width, small->spec.height = guide.height;
    // The mean of a block has the less noise the more pixels it has.
    small->m_noise = noise(parallel).times(1.0f / float(step));
    const Status status = small->simplify_guide({ guide }, parallel, progress);
    error = status.error();
    small->m_log->bands = status ? &small->guide_bands[0] : nullptr;
    stats.engine = small->stats.engine;
    return status.ok();
}

}  // namespace PIMG_ABI
}  // namespace pimg
