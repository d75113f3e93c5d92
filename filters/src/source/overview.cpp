// SPDX-License-Identifier: BSD-3-Clause
#include "source/overview.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <pimg/colour.h>
#include <pimg/simplify.h>

#include <pimg/detail/elementary.h>
#include <pimg/detail/parallel.h>

namespace pimg {
inline namespace PIMG_ABI {

namespace {

// Chosen by eye on the photographs of docs/look.md.
constexpr int kCells = 64;                            ///< on the longer side
constexpr double kRangeQuantile = 0.003;              ///< left out at each end of the dynamic range
constexpr float kAboveBlack = 0.01f;                  ///< guide units
constexpr float kLamp = 1.0f * kUnitsPerStop;         ///< how far a single pixel may outshine those around it
constexpr float kClearStep = 0.002f * kUnitsPerStop;  ///< between cells that are not one tone, such as those of a sky
constexpr float kLeastWeight = 0.01f;  ///< of what has one tone: pictures of nothing else have an exposure, too

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

/// The samples of a row. A pixel that outshines its surroundings, such as a firefly of a renderer or a hot pixel of a
/// camera, says nothing of the scene, but one of them may hold most of the light of a cell: so none is more than kLamp
/// above the second brightest of its neighbours. The brightest does not count, since two such pixels may touch.
void take_row(const Raster& log, int y, std::vector<float>& row)
{
    const int width = log.width;
    const auto sample = [&](int x, int at) {
        return log.samples[std::size_t(at) * std::size_t(width) + std::size_t(x)];
    };
    for (int x = 0; x < width; ++x) {
        const float here = row[std::size_t(x)] = sample(x, y);
        if (here <= std::min(sample(std::max(x - 1, 0), y), sample(std::min(x + 1, width - 1), y)) + kLamp)
            continue;
        float first = -std::numeric_limits<float>::max(), second = first;
        for (int j = std::max(y - 1, 0); j < std::min(y + 2, log.height); ++j)
            for (int i = std::max(x - 1, 0); i < std::min(x + 2, width); ++i)
                if (j != y || i != x) {
                    second = std::max(second, std::min(first, sample(i, j)));
                    first = std::max(first, sample(i, j));
                }
        row[std::size_t(x)] = std::min(here, second + kLamp);
    }
}

/// log2 of the mean luminance of the cells, in guide units.
Raster mean_luminance(const Raster& log, const ParallelFor& parallel)
{
    Raster means = grid_for(log);
    const float area = float(double(log.width) * log.height / double(means.samples.size()));
    const std::size_t count = std::size_t(log.width);
    for_rows(parallel, 0, means.height, [&](int row) {
        std::vector<float> light(count), sum(count);
        for_covered(row, means.height, log.height, [&](int y, float weight) {
            take_row(log, y, light);
            for (float& value : light)
                value /= kUnitsPerStop;
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

/// How much each cell says of the scene: little where nothing differs, as in a border of one tone.
std::vector<float> weights_of(const Raster& means, const std::vector<char>& lit)
{
    std::vector<float> weights(means.samples.size(), kLeastWeight);
    for (int y = 0; y < means.height; ++y)
        for (int x = 0; x < means.width; ++x) {
            const std::size_t at = std::size_t(y * means.width + x);
            float largest = 0.0f, step = 0.0f;  // the second largest: one is the edge of something that has one tone
            for (const auto& [i, j] : { std::pair(x - 1, y), { x + 1, y }, { x, y - 1 }, { x, y + 1 } }) {
                const std::size_t other = std::size_t(j * means.width + i);
                if (i < 0 || i >= means.width || j < 0 || j >= means.height || !lit[other])
                    continue;
                const float here = std::fabs(means.samples[at] - means.samples[other]);
                step = std::max(step, std::min(largest, here));
                largest = std::max(largest, here);
            }
            weights[at] = std::clamp(step / kClearStep, kLeastWeight, 1.0f);
        }
    return weights;
}

/// How much the pixels of a cell differ from planes, as a standard deviation in guide units (Immerkaer 1996, by the median).
/// 0 for cells that are too small to tell.
float roughness(const Raster& log, const OIIO::ROI& cell)
{
    std::vector<float> deviations;
    const auto second = [&](int x, int y) {
        const float* row = &log.samples[std::size_t(y) * std::size_t(log.width)];
        return row[x - 1] - 2.0f * row[x] + row[x + 1];
    };
    for (int y = cell.ybegin + 1; y + 1 < cell.yend; ++y)
        for (int x = cell.xbegin + 1; x + 1 < cell.xend; ++x)
            deviations.push_back(std::fabs(second(x, y - 1) - 2.0f * second(x, y) + second(x, y + 1)));
    constexpr std::size_t kLeast = 25;  ///< a line or a corner is most of what fewer pixels show
    if (deviations.size() < kLeast)
        return 0.0f;
    constexpr float kOfNormal =
        6.0f * 0.67449f;  ///< the filter's norm; median of the absolute values of a normal variable
    const auto middle = deviations.begin() + std::ptrdiff_t(deviations.size() / 2);
    std::nth_element(deviations.begin(), middle, deviations.end());
    return *middle / kOfNormal;
}

/// Cells that are neither black nor noise in the dark: far below the others, with pixels that have nothing in common. A
/// border of sensor noise says nothing of the scene.
std::vector<char> lit_cells(const LogLuminance& luminance, const Raster& means, const ParallelFor& parallel)
{
    // Of twelve photographs and panoramas, the hollow of one tree has such cells.
    constexpr float kRough = 0.5f * kUnitsPerStop;
    constexpr float kDark = 4.0f * kUnitsPerStop;  ///< below the lightest quarter of what is not black
    const Raster& log = luminance.guide;
    std::vector<char> lit;
    std::vector<float> light;
    for (const float mean : means.samples) {
        lit.push_back(mean > luminance.floor + kAboveBlack);
        if (lit.back())
            light.push_back(mean);
    }
    if (light.empty())
        return lit;
    const auto quarter = light.begin() + std::ptrdiff_t(light.size() * 3 / 4);
    std::nth_element(light.begin(), quarter, light.end());
    const float dark = *quarter - kDark;
    for_rows(parallel, 0, means.height, [&](int row) {
        for (int column = 0; column < means.width; ++column) {
            const std::size_t i = std::size_t(row * means.width + column);
            if (!lit[i] || means.samples[i] > dark)
                continue;
            const OIIO::ROI cell(column * log.width / means.width, (column + 1) * log.width / means.width,
                                 row * log.height / means.height, (row + 1) * log.height / means.height);
            if (roughness(log, cell) > kRough)
                lit[i] = 0;
        }
    });
    return lit;
}

}  // namespace

Status look_from_afar(const LogLuminance& luminance, const Wrap& wrap, const ParallelFor& parallel, Overview& overview)
{
    const Raster means = !wrap
        ? mean_luminance(luminance.guide, parallel)
        : mean_luminance({ wrap.width, wrap.height, without_margins(wrap, luminance.guide.samples) }, parallel);
    overview.log = means.samples;
    overview.lit = lit_cells(luminance, means, parallel);
    overview.weight = weights_of(means, overview.lit);
    std::vector<Weighted> lit;
    for (std::size_t i = 0; i < overview.log.size(); ++i)
        if (overview.lit[i])
            lit.push_back({ overview.log[i], overview.weight[i] * overview.weight[i] });
    overview.range = quantile(lit, 1.0 - kRangeQuantile) - quantile(lit, kRangeQuantile);

    SimplifyOptions options;
    options.parallel = parallel;
    const Status status = simplify({ means.width, means.height, { { means.samples.data() } } }, options,
                                   overview.hierarchy, overview.log_bands);
    if (status)
        overview.bands = std::make_unique<PlannedBands>(std::make_shared<SweepPlan>(overview.hierarchy, parallel),
                                                        overview.log_bands[0], parallel);
    return status;
}

float quantile(std::vector<Weighted>& numbers, double q)
{
    if (numbers.empty())
        return 0.0f;
    std::sort(numbers.begin(), numbers.end(), [](const Weighted& a, const Weighted& b) {
        return a.value != b.value ? a.value < b.value : a.weight < b.weight;
    });
    double total = 0.0;
    for (const Weighted& number : numbers)
        total += double(number.weight);
    // Each number stands at the middle of its weight.
    const double wanted = q * total;
    double before = 0.0;
    for (std::size_t i = 0; i + 1 < numbers.size(); ++i) {
        const double here = before + 0.5 * double(numbers[i].weight);
        before += double(numbers[i].weight);
        const double next = before + 0.5 * double(numbers[i + 1].weight);
        if (wanted < next) {
            const double share = std::clamp((wanted - here) / std::max(next - here, 1e-12), 0.0, 1.0);
            return numbers[i].value + float(share) * (numbers[i + 1].value - numbers[i].value);
        }
    }
    return numbers.back().value;
}

}  // namespace PIMG_ABI
}  // namespace pimg
