// SPDX-License-Identifier: BSD-3-Clause
#include "ops/painting/wrapped_tiling.h"

#include <cmath>
#include <deque>

#include "source/wrap/wrapped_pieces.h"

namespace pimg {
inline namespace PIMG_ABI {

namespace {

/// Farther from a joint than grout and slopes can be wide.
constexpr float kFar = 256.0f;

/// Two pixels with at least this distance from their joints have none between them.
constexpr float kNoJoint = 1.0f;

/// Finds the distances from joints that are missing.
class JointLayer {
public:
    JointLayer(const Wrap& wrap, Tiling& tiling) : m_wrap(wrap), m_tiling(tiling), m_nearest(wrap.pixels()) { }

    void lay()
    {
        for (int y = 0; y < m_wrap.height; ++y)
            for (int x = 0; x < m_wrap.width; ++x) {
                if (m_wrap.x || x + 1 < m_wrap.width)
                    lay_between(x, y, 1, 0);
                if (m_wrap.y || y + 1 < m_wrap.height)
                    lay_between(x, y, 0, 1);
            }
        for (; !m_queue.empty(); m_queue.pop_front())
            spread(int(m_queue.front() % Index(m_wrap.width)), int(m_queue.front() / Index(m_wrap.width)));
    }

private:
    /// From a pixel to the nearest point of a joint.
    struct Offset {
        float x = 0.0f, y = 0.0f;
    };

    Index number(int x, int y) const
    {
        return Index(modulo(y, m_wrap.height)) * Index(m_wrap.width) + Index(modulo(x, m_wrap.width));
    }

    void lay_between(int x, int y, int dx, int dy)
    {
        const Index p = number(x, y), q = number(x + dx, y + dy);
        if (m_tiling.tile[p] == m_tiling.tile[q] || m_tiling.inside[p] < kNoJoint || m_tiling.inside[q] < kNoJoint)
            return;
        improve(p, { 0.5f * float(dx), 0.5f * float(dy) });
        improve(q, { -0.5f * float(dx), -0.5f * float(dy) });
    }

    void improve(Index p, Offset offset)
    {
        const float distance = std::sqrt(offset.x * offset.x + offset.y * offset.y);
        if (!(distance < m_tiling.inside[p]))
            return;
        m_tiling.inside[p] = distance;
        m_tiling.away_x[p] = -offset.x / distance;
        m_tiling.away_y[p] = -offset.y / distance;
        m_nearest[p] = offset;
        m_queue.push_back(p);
    }

    void spread(int x, int y)
    {
        const Index p = number(x, y);
        for (int dy = -1; dy <= 1; ++dy)
            for (int dx = -1; dx <= 1; ++dx)
                if (number(x + dx, y + dy) != p)
                    improve(number(x + dx, y + dy), { m_nearest[p].x - float(dx), m_nearest[p].y - float(dy) });
    }

    const Wrap& m_wrap;
    Tiling& m_tiling;
    std::vector<Offset> m_nearest;
    std::deque<Index> m_queue;
};

}  // namespace

Tiling wrapped_tiling(const Wrap& wrap, const Tiling& tiling, Index tiles)
{
    if (!wrap)
        return tiling;
    Tiling result { wrap.width, wrap.height, {}, {}, {}, {} };
    const std::vector<Index> places = piece_places(wrap, tiling.tile, tiles);
    for (std::size_t p = 0; p < places.size(); ++p) {
        const int x = int(places[p] % Index(wrap.padded_width())) - wrap.margin_x;
        const int y = int(places[p] / Index(wrap.padded_width())) - wrap.margin_y;
        const bool is_its_own =
            std::size_t(modulo(y, wrap.height)) * std::size_t(wrap.width) + std::size_t(modulo(x, wrap.width)) == p;
        result.tile.push_back(tiling.tile[places[p]]);
        result.inside.push_back(is_its_own ? tiling.inside[places[p]] : kFar);
        result.away_x.push_back(is_its_own ? tiling.away_x[places[p]] : 0.0f);
        result.away_y.push_back(is_its_own ? tiling.away_y[places[p]] : 0.0f);
    }
    JointLayer(wrap, result).lay();
    return result;
}

}  // namespace PIMG_ABI
}  // namespace pimg
