// SPDX-License-Identifier: BSD-3-Clause
#include "source/samples/noise.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <pimg/colour.h>

#include <pimg/detail/elementary.h>
#include <pimg/detail/parallel.h>

namespace pimg {
inline namespace PIMG_ABI {

namespace {

// Chosen by eye on the photographs of docs/look.md, but for the property of the normal distribution.
constexpr int kBlock = 16;                ///< pixels on a side of the parts whose noise is estimated
constexpr std::size_t kBins = 12;         ///< groups of equally light blocks
constexpr std::size_t kLeastBlocks = 8;   ///< in a group: fewer do not tell its noise
constexpr double kSmoothest = 0.1;        ///< quantile of the deviations in a group that counts
constexpr double kMadOfNormal = 0.67449;  ///< median absolute value of a normal variable of standard deviation 1
constexpr float kAboveBlack = 0.01f;      ///< guide units

struct Block {
    double mean, variance;
};

/// Finds the mean luminance of a block and the variance of its noise. The noise is estimated from the second difference
/// along y of the second differences along x, which is 0 on planes and whose weights have the norm 6 (Immerkaer 1996).
/// False for blocks that are partly black.
bool measure(const LogLuminance& luminance, int column, int row, Block& block)
{
    const Raster& guide = luminance.guide;
    float y[kBlock][kBlock];
    double sum = 0.0;
    for (int j = 0; j < kBlock; ++j) {
        const float* samples =
            &guide.samples[std::size_t(row * kBlock + j) * std::size_t(guide.width) + std::size_t(column * kBlock)];
        for (int i = 0; i < kBlock; ++i) {
            if (samples[i] <= luminance.floor + kAboveBlack)
                return false;
            y[j][i] = samples[i] / kUnitsPerStop;
        }
        exp2_in_place(y[j], kBlock);
        for (int i = 0; i < kBlock; ++i)
            sum += double(y[j][i]);
    }
    std::vector<float> deviations;
    for (int j = 1; j + 1 < kBlock; ++j)
        for (int i = 1; i + 1 < kBlock; ++i) {
            const float above = y[j - 1][i - 1] - 2.0f * y[j - 1][i] + y[j - 1][i + 1];
            const float here = y[j][i - 1] - 2.0f * y[j][i] + y[j][i + 1];
            const float below = y[j + 1][i - 1] - 2.0f * y[j + 1][i] + y[j + 1][i + 1];
            deviations.push_back(std::fabs(above - 2.0f * here + below) / 6.0f);
        }
    const auto middle = deviations.begin() + std::ptrdiff_t(deviations.size() / 2);
    std::nth_element(deviations.begin(), middle, deviations.end());
    const double deviation = double(*middle) / kMadOfNormal;
    block = { sum / (kBlock * kBlock), deviation * deviation };
    return true;
}

std::vector<Block> measure_blocks(const LogLuminance& luminance, const ParallelFor& parallel)
{
    const int columns = luminance.guide.width / kBlock, rows = luminance.guide.height / kBlock;
    std::vector<std::vector<Block>> found(std::size_t(std::max(rows, 0)));
    for_rows(parallel, 0, rows, [&](int row) {
        Block block;
        for (int column = 0; column < columns; ++column)
            if (measure(luminance, column, row, block))
                found[std::size_t(row)].push_back(block);
    });
    std::vector<Block> blocks;
    for (const std::vector<Block>& row : found)
        blocks.insert(blocks.end(), row.begin(), row.end());
    return blocks;
}

/// From each group of about equally light blocks the one at the quantile kSmoothest of their noise.
std::vector<Block> smoothest(std::vector<Block> blocks)
{
    std::vector<Block> result;
    const auto order = [&](std::size_t first, std::size_t last, double Block::*by) {
        std::sort(blocks.begin() + std::ptrdiff_t(first), blocks.begin() + std::ptrdiff_t(last),
                  [&](const Block& a, const Block& b) {
                      return a.*by != b.*by ? a.*by < b.*by : a.mean + a.variance < b.mean + b.variance;
                  });
    };
    order(0, blocks.size(), &Block::mean);
    const std::size_t bins = std::min(kBins, blocks.size() / kLeastBlocks);
    for (std::size_t bin = 0; bin < bins; ++bin) {
        const std::size_t first = bin * blocks.size() / bins, last = (bin + 1) * blocks.size() / bins;
        order(first, last, &Block::variance);
        result.push_back(blocks[first + std::size_t(kSmoothest * double(last - first))]);
    }
    return result;
}

/// How far the variances of `blocks` are from read + photon * mean, as the sum of the absolute differences of
/// logarithms.
double distance(const std::vector<Block>& blocks, double read, double photon)
{
    double sum = 0.0;
    for (const Block& block : blocks)
        sum += std::fabs(elementary::log2(block.variance) - elementary::log2(read + photon * block.mean));
    return sum;
}

}  // namespace

NoiseModel estimate_noise(const LogLuminance& luminance, const ParallelFor& parallel)
{
    std::vector<Block> blocks = smoothest(measure_blocks(luminance, parallel));
    NoiseModel best;
    best.reference = luminance.reference;
    // Groups without any noise are synthetic or clipped parts, which do not tell the noise of the rest.
    blocks.erase(std::remove_if(blocks.begin(), blocks.end(), [](const Block& b) { return !(b.variance > 1e-14); }),
                 blocks.end());
    // Of all lines through two of the groups, the one nearest to all groups is taken. This is robust, and twelve groups
    // have few pairs.
    double least = std::numeric_limits<double>::max();
    const auto consider = [&](double read, double photon) {
        if (read < 0.0 || photon < 0.0 || !(read + photon > 0.0))
            return;
        if (const double d = distance(blocks, read, photon); d < least) {
            least = d;
            best.read = float(read * double(luminance.reference) * double(luminance.reference));
            best.photon = float(photon * double(luminance.reference));
        }
    };
    for (std::size_t i = 0; i < blocks.size(); ++i) {
        const Block& a = blocks[i];
        consider(a.variance, 0.0);
        consider(0.0, a.variance / a.mean);
        for (std::size_t j = i + 1; j < blocks.size(); ++j) {
            const Block& b = blocks[j];
            const double photon = (b.variance - a.variance) / std::max(b.mean - a.mean, 1e-30);
            consider(a.variance - photon * a.mean, photon);
        }
    }
    return best;
}

NoiseTable::NoiseTable(const NoiseModel& noise)
{
    const double read = double(noise.read) / (double(noise.reference) * double(noise.reference));
    const double photon = double(noise.photon) / double(noise.reference);
    constexpr double kInverseLn2 = 1.4426950408889634;
    for (int i = 0; i <= kSteps; ++i) {
        const double y = elementary::exp2(double(kFirst + float(i) * kStep) / double(kUnitsPerStop));
        m_values.push_back(float(std::sqrt(read + photon * y) / y * kInverseLn2) * kUnitsPerStop);
    }
}

}  // namespace PIMG_ABI
}  // namespace pimg
