// SPDX-License-Identifier: BSD-3-Clause
// Cells grow from seeds, the nearest pixel first, as the superpixels of Achanta and Suesstrunk ("Superpixels and polygons using
// simple non-iterative clustering", 2017) do. So each is connected. Then the seeds move to the middles of their cells, and
// the cells grow again: Lloyd's algorithm, for which differences of colour are distances, too.
#include <pimg/mosaic.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include <pimg/detail/elementary.h>
#include <pimg/detail/stop.h>

#include "sketch.h"

namespace pimg {
inline namespace PIMG_ABI {

namespace {

/// Colour difference, in 8-bit steps, that counts as much as the distance from the middle of a cell to its border. By eye: less
/// makes cells ragged in texture, more lets them cross faint edges.
constexpr float kAlike = 28.0f;

/// How far cells are of different sizes, as a power of the sizes of the pieces: at 0 all cells want to be equally large, at 1
/// large pieces stay large.
constexpr double kPower = 0.6;

/// Rounds of growing. After three, the seeds move by less than a tenth of a cell.
constexpr int kRounds = 3;

/// Pixels across a cell that the first rounds need; larger pictures are shrunk for them.
constexpr float kEnough = 8.0f;

struct Seed {
    Vec2 place;          ///< in pixels of the picture
    float inverse_size;  ///< 1 / (the distance that counts as 1)^2
    Shade shade;
};

std::vector<Seed> seeds_of(const Mesh& mesh, const ShadePicture& picture)
{
    std::vector<Seed> seeds(mesh.size());
    std::vector<float> areas(mesh.size());
    double total = 0.0;
    for (Index v = 0; v < mesh.size(); ++v) {
        const std::vector<Vec2> polygon = piece_polygon(mesh, v);
        float twice = 0.0f, x = 0.0f, y = 0.0f;
        for (std::size_t i = 0, j = polygon.size() - 1; i < polygon.size(); j = i++) {
            twice += polygon[j].x * polygon[i].y - polygon[i].x * polygon[j].y;
            x += polygon[i].x / float(polygon.size());
            y += polygon[i].y / float(polygon.size());
        }
        areas[v] = std::max(0.5f * std::fabs(twice), 1.0f);
        total += double(areas[v]);
        seeds[v] = { { x, y }, 1.0f, picture.at({ x, y }) };
    }
    const float mean = float(total / double(mesh.size()));
    for (Index v = 0; v < mesh.size(); ++v)
        seeds[v].inverse_size = 1.0f / (0.25f * mean * float(elementary::power(double(areas[v] / mean), kPower)));
    return seeds;
}

/// A place that a seed may take.
struct Claim {
    Index at, seed;
};

/// Claims, the nearest first, to about 1 % of their distances: those of a bucket have the same exponent and the same first
/// seven bits of the mantissa. The last to come is the first to go, which keeps to memory just used.
class ClaimQueue {
public:
    ClaimQueue() : m_buckets(std::size_t(1) << 15) { }

    void push(float distance, Claim claim)
    {
        std::uint32_t bits = 0;
        std::memcpy(&bits, &distance, sizeof bits);
        const std::size_t bucket = bits >> 16;  // distances are not negative, so that their bits are in their order
        m_buckets[bucket].push_back(claim);
        m_first = std::min(m_first, bucket);
    }

    /// False if none is left.
    bool pop(Claim& claim)
    {
        while (m_first < m_buckets.size() && m_buckets[m_first].empty())
            ++m_first;
        if (m_first == m_buckets.size())
            return false;
        claim = m_buckets[m_first].back();
        m_buckets[m_first].pop_back();
        return true;
    }

private:
    std::vector<std::vector<Claim>> m_buckets;
    std::size_t m_first = 0;
};

/// One round on a grid of every `step`-th pixel.
class Growth {
public:
    Growth(const std::vector<Seed>& seeds, const ShadePicture& picture, int width, int height, int step)
        : m_seeds(seeds),
          m_picture(picture),
          m_step(step),
          m_columns((width + step - 1) / step),
          m_rows((height + step - 1) / step),
          m_cell(std::size_t(m_columns) * std::size_t(m_rows), kGhost)
    {
    }

    const std::vector<Index>& grow()
    {
        for (Index s = 0; s < Index(m_seeds.size()); ++s)
            push(int(m_seeds[s].place.x) / m_step, int(m_seeds[s].place.y) / m_step, s);
        Claim claim {};
        for (std::size_t popped = 0; m_queue.pop(claim); ++popped) {
            if (popped % 65536 == 0)
                stop_point();
            if (m_cell[claim.at] != kGhost)
                continue;
            m_cell[claim.at] = claim.seed;
            const int x = int(claim.at % Index(m_columns)), y = int(claim.at / Index(m_columns));
            push(x - 1, y, claim.seed);
            push(x + 1, y, claim.seed);
            push(x, y - 1, claim.seed);
            push(x, y + 1, claim.seed);
        }
        return m_cell;
    }

    /// Moves the seeds to the middles of their cells. A seed whose cell has no pixels stays.
    void centre(std::vector<Seed>& seeds) const
    {
        struct Sum {
            double x = 0.0, y = 0.0, count = 0.0, shade[3] = {};
        };
        std::vector<Sum> sums(seeds.size());
        for (std::size_t at = 0; at < m_cell.size(); ++at) {
            if (m_cell[at] == kGhost)
                continue;
            Sum& sum = sums[m_cell[at]];
            const Vec2 p = place(int(at % std::size_t(m_columns)), int(at / std::size_t(m_columns)));
            sum.x += double(p.x);
            sum.y += double(p.y);
            sum.count += 1.0;
            for (std::size_t c = 0; c < 3; ++c)
                sum.shade[c] += double(m_picture.at(p)[c]);
        }
        for (std::size_t s = 0; s < seeds.size(); ++s)
            if (sums[s].count > 0.0) {
                seeds[s].place = { float(sums[s].x / sums[s].count), float(sums[s].y / sums[s].count) };
                for (std::size_t c = 0; c < 3; ++c)
                    seeds[s].shade[c] = float(sums[s].shade[c] / sums[s].count);
            }
    }

private:
    Vec2 place(int x, int y) const
    {
        const float half = 0.5f * float(m_step - 1);
        return { float(x * m_step) + half, float(y * m_step) + half };
    }

    void push(int x, int y, Index s)
    {
        if (x < 0 || y < 0 || x >= m_columns || y >= m_rows)
            return;
        const std::size_t at = std::size_t(y) * std::size_t(m_columns) + std::size_t(x);
        if (m_cell[at] != kGhost)
            return;
        const Seed& seed = m_seeds[s];
        const Vec2 p = place(x, y);
        const float dx = p.x - seed.place.x, dy = p.y - seed.place.y;
        const float off = m_picture.distance(m_picture.at(p), seed.shade) / kAlike;
        m_queue.push((dx * dx + dy * dy) * seed.inverse_size + off * off, { Index(at), s });
    }

    const std::vector<Seed>& m_seeds;
    const ShadePicture& m_picture;
    int m_step, m_columns, m_rows;
    std::vector<Index> m_cell;
    ClaimQueue m_queue;
};

}  // namespace

std::vector<Index> grow_cells(const Mesh& mesh, const ChannelsView& guides, const ParallelFor& parallel)
{
    const ShadePyramid pictures(guides, parallel);
    std::vector<Seed> seeds = seeds_of(mesh, pictures.finest());
    const float across = std::sqrt(float(guides.width) * float(guides.height) / float(std::max<Index>(1, mesh.size())));
    const int step = std::max(1, int(across / kEnough));
    for (int round = 0; round + 1 < kRounds; ++round) {
        Growth growth(seeds, pictures.for_width(float(8 * step)), guides.width, guides.height, step);
        growth.grow();
        growth.centre(seeds);
    }
    return Growth(seeds, pictures.finest(), guides.width, guides.height, 1).grow();
}

}  // namespace PIMG_ABI
}  // namespace pimg
