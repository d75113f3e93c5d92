// SPDX-License-Identifier: BSD-3-Clause
// Distances from joints by sweeping vectors to the nearest one over the picture, down and up again (Danielsson, "Euclidean
// distance mapping", 1980). Corners are rounded by what remains of a tile where a disc fits in: deep inside it keeps its
// distances, and elsewhere they are those from the nearest place that is deep inside.
#include <pimg/direction.h>
#include <pimg/mosaic.h>

#include <algorithm>
#include <cmath>

namespace pimg {
inline namespace PIMG_ABI {

namespace {

constexpr float kFarAway = 1e15f;  ///< its square is finite

/// Vectors from pixels to the nearest of some places.
class NearestPlaces {
public:
    NearestPlaces(int width, int height)
        : m_width(width),
          m_height(height),
          m_way(std::size_t(width) * std::size_t(height), Vec2 { kFarAway, 0.0f })
    {
    }

    void set(std::size_t at, Vec2 way)
    {
        if (square(way) < square(m_way[at]))
            m_way[at] = way;
    }
    Vec2 way(std::size_t at) const { return m_way[at]; }
    float distance(std::size_t at) const { return std::sqrt(square(m_way[at])); }

    /// Spreads the vectors to all pixels. `may_pass(from, to)` says whether they may go from pixel to pixel.
    template<class MayPass>
    void sweep(MayPass&& may_pass)
    {
        for (int y = 0; y < m_height; ++y) {
            for (int x = 0; x < m_width; ++x) {
                take(x, y, 0, -1, may_pass);
                take(x, y, -1, -1, may_pass);
                take(x, y, 1, -1, may_pass);
                take(x, y, -1, 0, may_pass);
            }
            for (int x = m_width - 1; x >= 0; --x)
                take(x, y, 1, 0, may_pass);
        }
        for (int y = m_height - 1; y >= 0; --y) {
            for (int x = m_width - 1; x >= 0; --x) {
                take(x, y, 0, 1, may_pass);
                take(x, y, -1, 1, may_pass);
                take(x, y, 1, 1, may_pass);
                take(x, y, 1, 0, may_pass);
            }
            for (int x = 0; x < m_width; ++x)
                take(x, y, -1, 0, may_pass);
        }
    }

private:
    static float square(Vec2 v) { return v.x * v.x + v.y * v.y; }

    template<class MayPass>
    void take(int x, int y, int dx, int dy, MayPass&& may_pass)
    {
        if (x + dx < 0 || y + dy < 0 || x + dx >= m_width || y + dy >= m_height)
            return;
        const std::size_t to = std::size_t(y) * std::size_t(m_width) + std::size_t(x);
        const std::size_t from = std::size_t(y + dy) * std::size_t(m_width) + std::size_t(x + dx);
        const Vec2 w = m_way[from];
        if (w.x < kFarAway && may_pass(from, to))
            set(to, { w.x + float(dx), w.y + float(dy) });
    }

    int m_width, m_height;
    std::vector<Vec2> m_way;
};

/// The vectors to the nearest joint: joints lie half way between pixels of different tiles.
NearestPlaces joints_of(const std::vector<Index>& labels, int width, int height)
{
    NearestPlaces joints(width, height);
    const auto joint = [&](std::size_t a, std::size_t b, Vec2 way) {
        if (labels[a] != labels[b]) {
            joints.set(a, way);
            joints.set(b, { -way.x, -way.y });
        }
    };
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const std::size_t at = std::size_t(y) * std::size_t(width) + std::size_t(x);
            if (x + 1 < width)
                joint(at, at + 1, { 0.5f, 0.0f });
            if (y + 1 < height)
                joint(at, at + std::size_t(width), { 0.0f, 0.5f });
        }
    joints.sweep([](std::size_t, std::size_t) { return true; });
    return joints;
}

void put(Tiling& tiling, std::size_t at, float inside, Vec2 away)
{
    const float length = std::sqrt(away.x * away.x + away.y * away.y);
    tiling.inside[at] = inside;
    tiling.away_x[at] = length > 0.0f ? away.x / length : 0.0f;
    tiling.away_y[at] = length > 0.0f ? away.y / length : 0.0f;
}

}  // namespace

Tiling tiling_of(const std::vector<Index>& labels, int width, int height, Index tiles, float round)
{
    constexpr float kNoJoint = 1e6f;  // from a joint, if there is none
    Tiling tiling { width, height, labels, {}, {}, {} };
    tiling.inside.resize(labels.size());
    tiling.away_x.resize(labels.size());
    tiling.away_y.resize(labels.size());
    const NearestPlaces joints = joints_of(labels, width, height);
    std::vector<float> radius(tiles, 0.0f);
    for (std::size_t at = 0; at < labels.size(); ++at) {
        const Vec2 way = joints.way(at);
        put(tiling, at, std::min(joints.distance(at), kNoJoint), { -way.x, -way.y });
        radius[labels[at]] = std::max(radius[labels[at]], tiling.inside[at]);
    }
    if (round <= 0.0f)
        return tiling;
    NearestPlaces cores(width, height);
    for (std::size_t at = 0; at < labels.size(); ++at)
        if (tiling.inside[at] >= round * radius[labels[at]])
            cores.set(at, {});
    cores.sweep([&](std::size_t from, std::size_t to) { return labels[from] == labels[to]; });
    for (std::size_t at = 0; at < labels.size(); ++at)
        if (const float off = cores.distance(at); off > 0.0f && radius[labels[at]] < kNoJoint)
            put(tiling, at, round * radius[labels[at]] - off, cores.way(at));
    return tiling;
}

}  // namespace PIMG_ABI
}  // namespace pimg
