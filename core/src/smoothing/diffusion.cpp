// SPDX-License-Identifier: BSD-3-Clause
// All steps are taken in one pass over the rows: when row r is read, step s can do row r - s. What is in flight, a few
// rows for each step, stays in the cache, so a step costs arithmetic and no memory traffic.
#include <pimg/detail/diffusion.h>
#include <pimg/detail/elementary.h>
#include <pimg/detail/parallel.h>

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "smoothing/diffusion_rows.h"

namespace pimg {
inline namespace PIMG_ABI {

namespace {

constexpr int kBandRows = 128;  ///< rows of one task; each repeats `steps` rows of its neighbours

/// Lengths of the steps of one cycle. Single steps exceed the stability limit of 1/4, the whole cycle is stable;
/// long and short ones take turns so that rounding cannot grow in between.
std::vector<float> step_lengths(int steps)
{
    std::vector<float> rising;
    for (int i = 0; i < steps; ++i) {
        const double c = elementary::sine_cosine(elementary::kPi * (2 * i + 1) / (4.0 * steps + 2.0)).cosine;
        rising.push_back(float(0.125 / (c * c)));
    }
    std::vector<float> lengths;
    for (int low = 0, high = steps - 1; low <= high; ++low, --high) {
        lengths.push_back(rising[std::size_t(low)]);
        if (low != high)
            lengths.push_back(rising[std::size_t(high)]);
    }
    return lengths;
}

/// A few successive rows of a picture; row y is kept until row y + rows replaces it. Every row has one more
/// sample on either side.
class RowRing {
public:
    RowRing(int width, int rows)
        : m_stride(std::size_t(width) + 2),
          m_rows(rows),
          m_samples(m_stride * std::size_t(rows))
    {
    }
    float* row(int y) { return &m_samples[m_stride * std::size_t((y + m_rows) % m_rows) + 1]; }

private:
    std::size_t m_stride;
    int m_rows;
    std::vector<float> m_samples;
};

/// Diffusion of the rows [begin, end).
class BandDiffusion {
public:
    BandDiffusion(const Channels& guide, const DiffusionOptions& options)
        : m_guide(guide),
          m_width(options.width),
          m_height(options.height),
          m_steps(options.steps),
          m_lengths(step_lengths(m_steps)),
          m_right(m_width, m_steps + 3),
          m_down(m_width, m_steps + 3),
          m_scale(1.0f / (options.contrast * options.contrast * float(guide.size()))),
          m_share(options.share)
    {
    }

    void run(int begin, int end, const Channels& picture, Channels& result);

private:
    void conductances(int y);
    void load(const float* samples, const float* guide, int y, RowRing& ring) const;
    void step(int s, int y, int last, RowRing& from, float* to);

    const Channels& m_guide;
    int m_width, m_height, m_steps;
    std::vector<float> m_lengths;
    RowRing m_right, m_down;  ///< conductances to the right and lower neighbours
    float m_scale, m_share;
};

/// Row y of both conductances; none leads out of the picture.
void BandDiffusion::conductances(int y)
{
    float* right = m_right.row(y);
    float* down = m_down.row(y);
    const std::size_t at = std::size_t(y) * std::size_t(m_width), below = y + 1 < m_height ? std::size_t(m_width) : 0;
    std::fill(right, right + m_width, 0.0f);
    std::fill(down, down + m_width, 0.0f);
    const std::size_t count = std::size_t(m_width);
    for (const std::vector<float>& channel : m_guide) {
        const float* g = &channel[at];
        add_squares(g, g + 1, count - 1, right);
        add_squares(g, g + below, count, down);
    }
    to_conductances(m_scale, count, right);
    to_conductances(m_scale, count, down);
    right[-1] = right[m_width - 1] = 0.0f;
    if (below == 0)
        std::fill(down, down + m_width, 0.0f);
}

void BandDiffusion::load(const float* samples, const float* guide, int y, RowRing& ring) const
{
    const std::size_t first = std::size_t(y) * std::size_t(m_width);
    float* row = ring.row(y);
    if (m_share == 1.0f)
        std::copy_n(samples + first, m_width, row);
    else
        mix_rows(guide + first, samples + first, m_share, std::size_t(m_width), row);
    row[-1] = row[m_width] = 0.0f;  // met only with a conductance of zero
}

/// Step s for row y: from the rows around it to `to`. `last` is the last row there is.
void BandDiffusion::step(int s, int y, int last, RowRing& from, float* to)
{
    const float* row = from.row(y);
    const float* down = m_down.row(y);
    diffuse_row({ row, y > 0 ? from.row(y - 1) : row, y < last ? from.row(y + 1) : row, m_right.row(y),
                  y > 0 ? m_down.row(y - 1) : down, down },
                m_lengths[std::size_t(s - 1)], std::size_t(m_width), to);
}

void BandDiffusion::run(int begin, int end, const Channels& picture, Channels& result)
{
    // Rows further out than the steps reach do not matter; the outermost ones come out wrong and are not used.
    const int first = std::max(begin - m_steps, 0), last = std::min(end + m_steps, m_height) - 1;
    std::vector<std::vector<RowRing>> stages(picture.size(),
                                             std::vector<RowRing>(std::size_t(m_steps), RowRing(m_width, 3)));
    for (int r = first; r <= last + m_steps; ++r) {
        if (r <= last)
            conductances(r);
        for (std::size_t c = 0; c < picture.size(); ++c) {
            if (r <= last)
                load(picture[c].data(), m_guide[std::min(c, m_guide.size() - 1)].data(), r, stages[c][0]);
            for (int s = 1; s <= m_steps; ++s) {
                const int y = r - s;
                if (y < first || y > last)
                    continue;
                RowRing& from = stages[c][std::size_t(s - 1)];
                if (s < m_steps) {
                    float* to = stages[c][std::size_t(s)].row(y);
                    step(s, y, last, from, to);
                    to[-1] = to[m_width] = 0.0f;
                } else if (y >= begin && y < end) {
                    step(s, y, last, from, &result[c][std::size_t(y) * std::size_t(m_width)]);
                }
            }
        }
    }
}

}  // namespace

void diffuse(const Channels& guide, const DiffusionOptions& options, const Channels& picture, Channels& result)
{
    result.resize(picture.size());
    for (std::size_t c = 0; c < picture.size(); ++c)
        result[c].resize(picture[c].size());
    const int bands = (options.height + kBandRows - 1) / kBandRows;
    run(options.parallel, std::size_t(bands), [&](std::size_t i) {
        const int begin = int(i) * kBandRows;
        BandDiffusion(guide, options).run(begin, std::min(begin + kBandRows, options.height), picture, result);
    });
}

}  // namespace PIMG_ABI
}  // namespace pimg
