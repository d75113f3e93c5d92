// SPDX-License-Identifier: BSD-3-Clause
#include "source/overview.h"

#include <algorithm>
#include <cmath>

#include <pimg/colour.h>
#include <pimg/simplify.h>

#include <pimg/detail/elementary.h>
#include <pimg/detail/parallel.h>

namespace pimg {

namespace {

constexpr int kCells = 64;                ///< on the longer side
constexpr double kRangeQuantile = 0.003;  ///< left out at each end of the dynamic range
constexpr float kAboveBlack = 0.01f;      ///< guide units

/// Calls body(i, weight) for the samples that cell number `cell` of `cells` covers, wholly or in part.
template<class Body>
void for_covered(int cell, int cells, int samples, Body&& body)
{
    const double begin = double(cell) * samples / cells, end = double(cell + 1) * samples / cells;
    for (int i = int(begin); i < samples && double(i) < end; ++i)
        body(i, float(std::min(end, i + 1.0) - std::max(begin, double(i))));
}

/// The picture's longer side in kCells cells, the other as it comes; pixels if there are no more of them.
Raster grid_for(const Raster& picture)
{
    const int longer = std::max(picture.width, picture.height), cells = std::min(longer, kCells);
    const auto cells_for = [&](int side) {
        return std::max(int(std::lround(double(side) * cells / longer)), 1);
    };
    Raster grid { cells_for(picture.width), cells_for(picture.height), {} };
    grid.samples.resize(std::size_t(grid.width) * std::size_t(grid.height));
    return grid;
}

Raster mean_luminance(const Raster& log, const ParallelFor& parallel)
{
    Raster means = grid_for(log);
    const float area = float(double(log.width) * log.height / double(means.samples.size()));
    const std::size_t count = std::size_t(log.width);
    for_rows(parallel, 0, means.height, [&](int row) {
        std::vector<float> light(count), sum(count);
        for_covered(row, means.height, log.height, [&](int y, float weight) {
            const float* samples = &log.samples[std::size_t(y) * count];
            for (std::size_t x = 0; x < count; ++x)
                light[x] = samples[x] / kUnitsPerStop;
            exp2_in_place(light.data(), count);
            for (std::size_t x = 0; x < count; ++x)
                sum[x] += weight * light[x];
        });
        for (int column = 0; column < means.width; ++column) {
            float total = 0.0f;
            for_covered(column, means.width, log.width, [&](int x, float w) { total += w * sum[std::size_t(x)]; });
            means.samples[std::size_t(row * means.width + column)] =
                float(elementary::log2(double(total / area))) * kUnitsPerStop;
        }
    });
    return means;
}

}  // namespace

Status look_from_afar(const LogLuminance& luminance, const ParallelFor& parallel, Overview& overview)
{
    const Raster means = mean_luminance(luminance.guide, parallel);
    overview.log = means.samples;
    std::vector<float> lit;
    for (const float value : overview.log) {
        overview.lit.push_back(value > luminance.floor + kAboveBlack);
        if (overview.lit.back())
            lit.push_back(value);
    }
    std::sort(lit.begin(), lit.end());
    overview.range = quantile(lit, 1.0 - kRangeQuantile) - quantile(lit, kRangeQuantile);

    SimplifyOptions options;
    options.parallel = parallel;
    std::vector<Bands> bands;
    const Status status =
        simplify({ means.width, means.height, { { means.samples.data() } } }, options, overview.hierarchy, bands);
    if (status)
        overview.bands = std::make_unique<PlannedBands>(SweepPlan(overview.hierarchy, parallel), bands[0], parallel);
    return status;
}

float quantile(const std::vector<float>& sorted, double q)
{
    if (sorted.empty())
        return 0.0f;
    const double at = q * double(sorted.size() - 1);
    const std::size_t i = std::size_t(at);
    const float next = sorted[std::min(i + 1, sorted.size() - 1)];
    return sorted[i] + float(at - double(i)) * (next - sorted[i]);
}

}  // namespace pimg
