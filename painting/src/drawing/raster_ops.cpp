// SPDX-License-Identifier: BSD-3-Clause
#include "drawing/raster_ops.h"

#include <pimg/detail/elementary.h>
#include <pimg/detail/parallel.h>

namespace pimg {
inline namespace PIMG_ABI {

namespace {

/// Standard deviations to either side that a Gaussian kernel reaches; 0.3 % of it lie beyond.
constexpr float kReach = 3.0f;

std::vector<float> gaussian(float sigma)
{
    const int reach = int(std::ceil(kReach * sigma));
    std::vector<float> kernel;
    float sum = 0.0f;
    for (int i = -reach; i <= reach; ++i) {
        const double t = double(i) / double(sigma);
        kernel.push_back(float(elementary::exp2(-0.5 / elementary::kLn2 * t * t)));
        sum += kernel.back();
    }
    for (float& weight : kernel)
        weight /= sum;
    return kernel;
}

/// The sample of a row of `size` that stands at `i`: outside, that of the mirror image.
int mirrored(int i, int size)
{
    const int period = 2 * size;
    i %= period;
    i = i < 0 ? i + period : i;
    return i < size ? i : period - 1 - i;
}

/// The weights of the old samples in each new one along one axis. All have the same number of weights.
struct Tents {
    std::vector<int> first;  ///< number of the first old sample, which may lie outside of the picture
    std::vector<float> weights;
    int count = 0;

    Tents(int size, int new_size)
    {
        const float scale = float(size) / float(new_size), reach = std::max(1.0f, scale);
        count = 2 * int(std::ceil(reach)) + 1;
        for (int i = 0; i < new_size; ++i) {
            const float centre = (float(i) + 0.5f) * scale - 0.5f;
            first.push_back(int(std::floor(centre + 0.5f)) - count / 2);
            float sum = 0.0f;
            for (int k = 0; k < count; ++k) {
                weights.push_back(std::max(0.0f, 1.0f - std::fabs(float(first.back() + k) - centre) / reach));
                sum += weights.back();
            }
            for (auto w = weights.end() - count; w != weights.end(); ++w)
                *w /= sum;
        }
    }
};

}  // namespace

Raster blurred(const Raster& raster, float sigma, const ParallelFor& parallel)
{
    const std::vector<float> kernel = gaussian(sigma);
    const int w = raster.width, h = raster.height, reach = int(kernel.size() / 2);
    Raster across = make_raster(w, h), result = make_raster(w, h);
    for_rows(parallel, 0, h, [&](int y) {
        const float* in = raster.samples.data() + std::size_t(y) * std::size_t(w);
        std::vector<float> padded(std::size_t(w + 2 * reach));
        for (int x = -reach; x < w + reach; ++x)
            padded[std::size_t(x + reach)] = in[mirrored(x, w)];
        float* out = across.samples.data() + std::size_t(y) * std::size_t(w);
        for (int k = 0; k <= 2 * reach; ++k)
            for (int x = 0; x < w; ++x)
                out[x] += kernel[std::size_t(k)] * padded[std::size_t(x + k)];
    });
    for_rows(parallel, 0, h, [&](int y) {
        float* out = result.samples.data() + std::size_t(y) * std::size_t(w);
        for (int k = -reach; k <= reach; ++k) {
            const float* in = across.samples.data() + std::size_t(mirrored(y + k, h)) * std::size_t(w);
            for (int x = 0; x < w; ++x)
                out[x] += kernel[std::size_t(k + reach)] * in[x];
        }
    });
    return result;
}

Raster resampled(const float* samples, int width, int height, int new_width, int new_height,
                 const ParallelFor& parallel)
{
    const Tents columns(width, new_width), rows(height, new_height);
    Raster across = make_raster(new_width, height), result = make_raster(new_width, new_height);
    for_rows(parallel, 0, height, [&](int y) {
        const float* in = samples + std::size_t(y) * std::size_t(width);
        float* out = across.samples.data() + std::size_t(y) * std::size_t(new_width);
        for (int x = 0; x < new_width; ++x)
            for (int k = 0; k < columns.count; ++k)
                out[x] += columns.weights[std::size_t(x * columns.count + k)]
                    * in[std::clamp(columns.first[std::size_t(x)] + k, 0, width - 1)];
    });
    for_rows(parallel, 0, new_height, [&](int y) {
        float* out = result.samples.data() + std::size_t(y) * std::size_t(new_width);
        for (int k = 0; k < rows.count; ++k) {
            const float weight = rows.weights[std::size_t(y * rows.count + k)];
            const float* in = across.samples.data()
                + std::size_t(std::clamp(rows.first[std::size_t(y)] + k, 0, height - 1)) * std::size_t(new_width);
            for (int x = 0; x < new_width; ++x)
                out[x] += weight * in[x];
        }
    });
    return result;
}

}  // namespace PIMG_ABI
}  // namespace pimg
