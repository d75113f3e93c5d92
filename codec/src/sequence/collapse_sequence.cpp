// SPDX-License-Identifier: BSD-3-Clause
// What writer and reader of the collapse sequence share: the grid they start from, and one collapse.
#include <pimg/detail/ring_edit.h>

#include "sequence/collapse_sequence.h"

#include <algorithm>
#include <array>
#include <utility>

#include "raster/samples.h"
#include "sequence/collapse_mesh.h"

namespace pimg {
inline namespace PIMG_ABI {

std::vector<std::int32_t> diagonal_guide(const PictureDesc& desc, const std::vector<ConstStridedChannel>& samples)
{
    const auto& c = desc.channels;
    const bool colour = c.size() >= 3 && c[0].type == c[1].type && c[0].type == c[2].type;
    PictureDesc used = desc;
    used.channels.resize(colour ? 3 : 1);
    const std::vector<ConstStridedChannel> first_channels(samples.begin(), samples.begin() + (colour ? 3 : 1));
    const Integers in = gather(used, first_channels, 0, 0, desc.data.width, desc.data.height);
    const int shift = mesh_shift(c[0].type);
    const std::uint32_t width = std::max(2u, in.width), height = std::max(2u, in.height);
    std::vector<std::int32_t> guide;
    guide.reserve(std::size_t(width) * height);
    for (std::uint32_t y = 0; y < height; ++y)
        for (std::uint32_t x = 0; x < width; ++x) {
            const std::size_t at = std::size_t(std::min(y, in.height - 1)) * in.width + std::min(x, in.width - 1);
            const std::int32_t first = in.channels[0][at] >> shift;
            guide.push_back(colour
                                ? 54 * first + 183 * (in.channels[1][at] >> shift) + 19 * (in.channels[2][at] >> shift)
                                : 256 * first);
        }
    return guide;
}

CollapseMesh::CollapseMesh(int width, int height) : m_width(width), m_height(height)
{
    const std::size_t n = std::size_t(width) * std::size_t(height);
    rings.resize(n);
    vertices.reserve(n);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            vertices.push_back({ { x * kSubpixels, y * kSubpixels }, Index(vertices.size()), 0 });
}

void CollapseMesh::connect(const std::vector<std::uint8_t>& falling)
{
    // The eight pixels around in ring order, the odd ones being diagonal.
    constexpr int kStepX[8] = { 1, 1, 0, -1, -1, -1, 0, 1 };
    constexpr int kStepY[8] = { 0, 1, 1, 1, 0, -1, -1, -1 };
    for (int y = 0; y < m_height; ++y)
        for (int x = 0; x < m_width; ++x) {
            const std::size_t v = std::size_t(y) * std::size_t(m_width) + std::size_t(x);
            Ring& ring = rings[v];
            int degree = 0;
            bool ghost = false;
            for (int k = 0; k < 8; ++k) {
                const int qx = x + kStepX[k], qy = y + kStepY[k];
                if (qx < 0 || qy < 0 || qx >= m_width || qy >= m_height) {
                    if (!ghost)
                        ring.v[std::size_t(degree++)] = kGhost;
                    ghost = true;
                    continue;
                }
                const std::size_t quad =
                    std::size_t(std::min(y, qy)) * std::size_t(m_width - 1) + std::size_t(std::min(x, qx));
                if ((k & 1) && (falling[quad] != 0) != (kStepX[k] == kStepY[k]))
                    continue;
                ring.v[std::size_t(degree++)] = Index(std::size_t(qy) * std::size_t(m_width) + std::size_t(qx));
            }
            vertices[v].degree = degree;
        }
}

void CollapseMesh::keep(const std::vector<Index>& survivors)
{
    std::vector<Index> number(size(), kGhost);
    for (std::size_t i = 0; i < survivors.size(); ++i)
        number[survivors[i]] = Index(i);
    for (std::size_t i = 0; i < survivors.size(); ++i) {
        vertices[i] = vertices[survivors[i]];
        rings[i] = rings[survivors[i]];
        for (int j = 0; j < vertices[i].degree; ++j) {
            Index& q = rings[i].v[std::size_t(j)];
            q = q == kGhost ? kGhost : number[q];
        }
    }
    vertices.resize(survivors.size());
    rings.resize(survivors.size());
}

bool CollapseMesh::load_star(Index t, Index u, CollapseStar& star) const
{
    const RingOf of_t { t, rings[t], vertices[t].degree }, of_u { u, rings[u], vertices[u].degree };
    if (!merge_rings(of_t, of_u, star, [&](Index q) { return vertices[q].degree; }))
        return false;
    for (int i = 0; i < star.degree; ++i)
        star.points[i] = star.ring[i] == kGhost ? Point {} : vertices[star.ring[i]].at;
    return true;
}

bool CollapseMesh::is_place_ok(CollapseStar& star, Index t, Index u, Point s) const
{
    const Point e = extent();
    const auto sides = [&](Point p) {
        return (p.x == 0 ? 1 : p.x == e.x ? 2 : 0) | (p.y == 0 ? 4 : p.y == e.y ? 8 : 0);
    };
    if (s.x < 0 || s.y < 0 || s.x > e.x || s.y > e.y || sides(s) != (sides(vertices[t].at) | sides(vertices[u].at)))
        return false;
    bool positive = true;
    for (int i = 0; i < star.degree; ++i) {
        const int next = i + 1 < star.degree ? i + 1 : 0;
        star.areas[i] = doubled_area(s, star.points[i], star.points[next]);
        positive &= star.areas[i] > 0 || star.ring[i] == kGhost || star.ring[next] == kGhost;
    }
    return positive;
}

void CollapseMesh::collapse(const CollapseStar& star, Index t, Index u, Point s)
{
    for (int i = star.vl + 1; i < star.degree; ++i)
        if (star.ring[i] != kGhost)
            replace(rings[star.ring[i]], vertices[star.ring[i]].degree, u, t);
    for (int i : { 0, star.vl }) {
        const Index q = star.ring[i];
        if (q != kGhost) {
            std::int32_t& degree = vertices[q].degree;
            degree = remove_at(rings[q], degree, find(rings[q], degree, u));
        }
    }
    std::copy(star.ring, star.ring + star.degree, rings[t].v.begin());
    vertices[t].degree = star.degree;
    vertices[u].degree = 0;
    vertices[t].at = s;
}

CollapseMesh::Candidates CollapseMesh::candidates(Index t) const
{
    Candidates found;
    const Point at = vertices[t].at;
    std::int64_t least = 0, second = 0;
    for (int j = 0; j < vertices[t].degree; ++j) {
        const Index q = rings[t].v[std::size_t(j)];
        if (q == kGhost || q < t)
            continue;
        const std::int64_t dx = vertices[q].at.x - at.x, dy = vertices[q].at.y - at.y, l = dx * dx + dy * dy;
        const bool nearer = found.count == 0 || l < least || (l == least && q < found.nearest);
        second = nearer ? least : found.count == 1 ? l : std::min(second, l);
        least = nearer ? l : least;
        found.nearest = nearer ? q : found.nearest;
        ++found.count;
    }
    std::uint32_t clear = 0;
    if (found.count > 1)
        clear = second == least ? 0 : 2 * second < 3 * least ? 1 : second < 3 * least ? 2 : 3;
    found.symbol_class = 4 * std::uint32_t(found.count) + clear;
    return found;
}

Index CollapseMesh::candidate(Index t, std::uint32_t choice) const
{
    std::array<std::pair<std::int64_t, Index>, kMaxDegree> found;
    std::size_t count = 0;
    for (int j = 0; j < vertices[t].degree; ++j) {
        const Index q = rings[t].v[std::size_t(j)];
        if (q == kGhost || q < t)
            continue;
        const std::int64_t dx = vertices[q].at.x - vertices[t].at.x, dy = vertices[q].at.y - vertices[t].at.y;
        found[count++] = { dx * dx + dy * dy, q };
    }
    std::sort(found.begin(), found.begin() + std::ptrdiff_t(count));
    return choice < count ? found[choice].second : kGhost;
}

CollapseClasses collapse_classes(Point t, Point u, Point extent)
{
    const std::uint32_t dx = std::uint32_t(std::abs(t.x - u.x)), dy = std::uint32_t(std::abs(t.y - u.y));
    const std::uint32_t size = std::min<std::uint32_t>(class_of(std::max(dx, dy)), 31);
    const bool on_pixels = ((t.x | t.y | u.x | u.y) & (kSubpixels - 1)) == 0;
    const std::uint32_t shape = dx > 2 * dy ? 0 : dy > 2 * dx ? 1 : 2;
    CollapseClasses c;
    c.x = on_pixels ? shape : 3 + std::min(size, 22u) + 23 * shape;
    c.y = c.x;
    c.x_free = !((t.x == 0 || t.x == extent.x) || (u.x == 0 || u.x == extent.x));
    c.y_free = !((t.y == 0 || t.y == extent.y) || (u.y == 0 || u.y == extent.y));
    return c;
}

}  // namespace PIMG_ABI
}  // namespace pimg
