// SPDX-License-Identifier: BSD-3-Clause
#include <pimg/detail/parallel.h>
#include <pimg/detail/ring_edit.h>

#include "sampling/guide_jump.h"
#include "simplify/working_mesh.h"

#include <algorithm>
#include <cmath>

namespace pimg {
inline namespace PIMG_ABI {

namespace {

/// Mean number of living vertices under which four tiles are merged into one.
constexpr Index kSmallTile = 1500;

/// Every second bit of a Morton code.
std::uint32_t morton_part(std::uint64_t code)
{
    std::uint32_t part = 0;
    for (int bit = 0; bit < 32; ++bit)
        part |= std::uint32_t((code >> (2 * bit)) & 1) << bit;
    return part;
}

/// A finest tile: its place in the grid and its pixels, half open.
struct PixelTile {
    std::uint32_t x, y;
    int x0, y0, x1, y1;
};

/// Visits the finest tiles in Morton order.
template<class Visit>
void for_tiles(int width, int height, Visit&& visit)
{
    constexpr int kTile = WorkingMesh::kTile;
    const std::uint32_t across = std::uint32_t((width + kTile - 1) / kTile);
    const std::uint32_t down = std::uint32_t((height + kTile - 1) / kTile);
    std::uint32_t side = 1;
    while (side < std::max(across, down))
        side *= 2;
    for (std::uint64_t code = 0; code < std::uint64_t(side) * side; ++code) {
        const std::uint32_t x = morton_part(code), y = morton_part(code >> 1);
        if (x < across && y < down)
            visit(PixelTile { x, y, int(x) * kTile, int(y) * kTile, std::min(width, int(x + 1) * kTile),
                              std::min(height, int(y + 1) * kTile) });
    }
}

}  // namespace

WorkingMesh::WorkingMesh(const Guide& guide, const ParallelFor& parallel)
    : more_channels(int(guide.channels.size()) - 1)
{
    const std::size_t n = std::size_t(guide.width) * std::size_t(guide.height);
    allocate(guide, n);
    std::vector<Index> number_of(n);
    number_vertices(guide.width, guide.height, parallel, number_of);
    run(parallel, std::size_t((guide.height + kTile - 1) / kTile), [&](std::size_t i) {
        build_rows(guide, int(i) * kTile, std::min(guide.height, int(i + 1) * kTile), number_of);
    });
}

WorkingMesh::WorkingMesh(const Guide& guide, const InitialMesh& initial) : more_channels(int(guide.channels.size()) - 1)
{
    allocate(guide, initial.pixels.size());
    std::vector<Index> number_of(initial.pixels.size());
    number_vertices(initial, number_of);
    for (Index v = 0; v < initial.vertices(); ++v)
        place(number_of[v], guide, initial.pixels[v], v);
    build_rings(initial, number_of);
    merge_small_tiles();
}

WorkingMesh::WorkingMesh(const Guide& guide, const Bisection& bisection, const ParallelFor& parallel)
    : more_channels(int(guide.channels.size()) - 1)
{
    allocate(guide, bisection.left());
    std::vector<Index> number_of(std::size_t(guide.width) * std::size_t(guide.height), kGhost);
    number_vertices(guide, bisection, parallel, number_of);
    in_batches(parallel, number_of.size(), [&](std::size_t pixel) {
        const Index v = number_of[pixel];
        if (v == kGhost)
            return;
        place(v, guide, Index(pixel), Index(pixel));
        Node& node = nodes[v];
        node.z = bisection.value(Index(pixel), 0);
        for (int c = 0; c < more_channels; ++c)
            more_of(v)[c].value = bisection.value(Index(pixel), c + 1);
        node.order = bisection.order(Index(pixel));
        Index* const ring = rings[v].v.data();
        node.degree = std::uint8_t(bisection.ring(Index(pixel), ring));
        for (int j = 0; j < node.degree; ++j)
            ring[j] = ring[j] == kGhost ? kGhost : number_of[ring[j]];
    });
    merge_small_tiles();
}

void WorkingMesh::allocate(const Guide& guide, std::size_t vertices)
{
    nodes.extend(vertices);
    rings.extend(vertices);
    keys.extend(vertices);
    more.resize(vertices * std::size_t(more_channels));
    for (const GuideChannel& c : guide.channels)
        weights.push_back(c.weight);
    m_alive = Index(vertices);
}

void WorkingMesh::number_vertices(int width, int height, const ParallelFor& parallel, std::vector<Index>& number_of)
{
    std::vector<PixelTile> pixels;
    Index next = 0;
    for_tiles(width, height, [&](const PixelTile& t) {
        const Index first = next;
        next += Index(t.x1 - t.x0) * Index(t.y1 - t.y0);
        tiles.push_back({ first, next, t.x, t.y });
        pixels.push_back(t);
    });
    run(parallel, tiles.size(), [&](std::size_t i) {
        const PixelTile& t = pixels[i];
        Index number = tiles[i].first;
        for (int y = t.y0; y < t.y1; ++y)
            for (int x = t.x0; x < t.x1; ++x)
                number_of[std::size_t(y) * std::size_t(width) + std::size_t(x)] = number++;
    });
}

void WorkingMesh::number_vertices(const Guide& guide, const Bisection& bisection, const ParallelFor& parallel,
                                  std::vector<Index>& number_of)
{
    std::vector<PixelTile> pixels;
    for_tiles(guide.width, guide.height, [&](const PixelTile& t) { pixels.push_back(t); });
    const auto for_left = [&](const PixelTile& t, auto&& visit) {
        for (int y = t.y0; y < t.y1; ++y)
            for (int x = t.x0; x < t.x1; ++x)
                if (const Index pixel = Index(y) * Index(guide.width) + Index(x); bisection.is_left(pixel))
                    visit(pixel);
    };
    tiles.resize(pixels.size());
    run(parallel, tiles.size(), [&](std::size_t i) {
        tiles[i] = { 0, 0, pixels[i].x, pixels[i].y };
        for_left(pixels[i], [&](Index) { ++tiles[i].last; });
    });
    Index next = 0;
    for (Tile& tile : tiles) {
        tile.first = next;
        tile.last = next += tile.last;
    }
    run(parallel, tiles.size(), [&](std::size_t i) {
        Index number = tiles[i].first;
        for_left(pixels[i], [&](Index pixel) { number_of[pixel] = number++; });
    });
}

void WorkingMesh::number_vertices(const InitialMesh& initial, std::vector<Index>& number_of)
{
    // Vertices are in row order, tiles are not: a binary search in each row finds the vertices of a tile.
    const std::size_t height = std::size_t(initial.height), width = std::size_t(initial.width);
    std::vector<Index> row_start(height + 1, initial.vertices());
    for (Index v = initial.vertices(); v-- > 0;)
        row_start[initial.pixels[v] / width] = v;
    for (std::size_t y = height; y-- > 0;)
        row_start[y] = std::min(row_start[y], row_start[y + 1]);
    Index next = 0;
    for_tiles(initial.width, initial.height, [&](const PixelTile& t) {
        const Index first = next;
        for (int y = t.y0; y < t.y1; ++y) {
            const std::size_t row = std::size_t(y) * width;
            const auto begin = initial.pixels.begin() + row_start[std::size_t(y)];
            const auto end = initial.pixels.begin() + row_start[std::size_t(y) + 1];
            for (auto p = std::lower_bound(begin, end, Index(row + std::size_t(t.x0)));
                 p != end && *p < row + std::size_t(t.x1); ++p)
                number_of[std::size_t(p - initial.pixels.begin())] = next++;
        }
        tiles.push_back({ first, next, t.x, t.y });
    });
}

/// Fills all of a node but its sums; its ring is left empty.
void WorkingMesh::place(Index v, const Guide& guide, Index pixel, Index name)
{
    const int x = int(pixel % Index(guide.width)), y = int(pixel / Index(guide.width));
    rings[v].v.fill(kNoVertex);
    Node& node = nodes[v] = Node {};
    node.side = std::uint8_t((x == 0 || x == guide.width - 1 ? kFixedX : kFree)
                             | (y == 0 || y == guide.height - 1 ? kFixedY : kFree));
    node.p = { x * kSubpixels, y * kSubpixels };
    node.z = guide.channels[0].samples[pixel];
    for (int c = 0; c < more_channels; ++c)
        more_of(v)[c].value = guide.channels[std::size_t(c) + 1].samples[pixel];
    node.name = name;
    node.home = { std::uint16_t(x / kBlock), std::uint16_t(y / kBlock) };
}

void WorkingMesh::build_rings(const InitialMesh& initial, const std::vector<Index>& number_of)
{
    const auto around = [](Index e, Index step) {
        return e - e % 3 + (e + step) % 3;
    };
    for (Index e = 0; e < Index(initial.corners.size()); ++e) {
        const Index v = number_of[initial.corners[e]];
        if (nodes[v].degree > 0 && initial.twins[e] != kGhost)
            continue;  // its ring is there already, and it is not a border vertex, whose ring must start at this edge
        Ring& ring = rings[v];
        int degree = 0;
        for (Index edge = e;;) {
            ring.v[std::size_t(degree++)] = number_of[initial.corners[around(edge, 1)]];
            const Index last = around(edge, 2), twin = initial.twins[last];
            if (twin == kGhost) {
                ring.v[std::size_t(degree++)] = number_of[initial.corners[last]];
                ring.v[std::size_t(degree++)] = kGhost;
                break;
            }
            if (twin == e)
                break;
            edge = twin;
        }
        nodes[v].degree = std::uint8_t(degree);
    }
}

/// One vertex per pixel of rows [first, last).
void WorkingMesh::build_rows(const Guide& guide, int first, int last, const std::vector<Index>& number_of)
{
    const int width = guide.width, height = guide.height;
    const auto number_at = [&](int x, int y) {
        const bool inside = x >= 0 && y >= 0 && x < width && y < height;
        return inside ? number_of[std::size_t(y) * std::size_t(width) + std::size_t(x)] : kGhost;
    };
    // Diagonals of the quads above and below row y, from the one left of the picture, where they mean nothing.
    std::vector<std::uint8_t> above(std::size_t(width) + 1), below(std::size_t(width) + 1);
    const auto fill_below = [&](int y) {
        for (int x = 0; y >= 0 && y + 1 < height && x + 1 < width; ++x)
            below[std::size_t(x) + 1] = is_falling(guide, Index(y) * Index(width) + Index(x));
    };
    fill_below(first - 1);
    for (int y = first; y < last; ++y) {
        above.swap(below);
        fill_below(y);
        for (int x = 0; x < width; ++x) {
            const Index pixel = Index(y) * Index(width) + Index(x), v = number_of[pixel];
            place(v, guide, pixel, pixel);
            Index* const ring = rings[v].v.data();
            int degree = 0;
            const bool is_inner = x > 0 && y > 0 && x + 1 < width && y + 1 < height;
            const auto add = [&](int qx, int qy, bool linked) {
                if (is_inner) {
                    ring[degree] = number_of[std::size_t(qy) * std::size_t(width) + std::size_t(qx)];
                    degree += linked;
                    return;
                }
                // The ghost is in the ring once, however many steps lead out of the picture.
                const Index q = number_at(qx, qy);
                if (q == kGhost ? find(rings[v], degree, kGhost) < 0 : linked)
                    ring[degree++] = q;
            };
            const std::size_t left = std::size_t(x), right = left + 1;
            add(x + 1, y, true);
            add(x + 1, y + 1, below[right]);
            add(x, y + 1, true);
            add(x - 1, y + 1, !below[left]);
            add(x - 1, y, true);
            add(x - 1, y - 1, above[left]);
            add(x, y - 1, true);
            add(x + 1, y - 1, !above[right]);
            ring[degree] = kNoVertex;
            nodes[v].degree = std::uint8_t(degree);
        }
    }
}

Zone WorkingMesh::zone(const Tile& tile) const
{
    const std::int32_t n = std::int32_t(m_blocks_per_tile), half = n / 2;
    const std::int32_t x = std::int32_t(tile.x) * n, y = std::int32_t(tile.y) * n;
    return { x - half, y - half, x + n + half, y + n + half };
}

std::size_t WorkingMesh::bytes() const
{
    return nodes.size() * (sizeof(Node) + sizeof(Ring) + sizeof(float)) + more.size() * sizeof(MoreOfNode);
}

/// Moves the living of a tile to its beginning and returns how many they are. `number_of` receives their places in it.
Index WorkingMesh::close_ranks(const Tile& tile, std::vector<Index>& number_of)
{
    Index next = tile.first;
    for (Index v = tile.first; v < tile.last; ++v)
        if (nodes[v].degree > 0) {
            number_of[v] = next - tile.first;
            nodes[next] = nodes[v];
            rings[next] = rings[v];
            keys[next] = keys[v];
            std::copy(more_of(v), more_of(v) + more_channels, more_of(next));
            ++next;
        }
    return next - tile.first;
}

void WorkingMesh::compact_if_sparse(const ParallelFor& parallel)
{
    if (std::size_t(m_alive) * 2 > nodes.size())
        return;
    std::vector<Index> number_of(nodes.size());
    const std::vector<Tile> before = tiles;
    std::vector<Index> counts(tiles.size());
    run(parallel, tiles.size(), [&](std::size_t i) { counts[i] = close_ranks(tiles[i], number_of); });
    Index next = 0;
    for (std::size_t i = 0; i < tiles.size(); ++i) {
        tiles[i].first = next;
        tiles[i].last = next += counts[i];
    }
    const auto close_up = [&](auto& array, std::size_t each) {
        for (std::size_t i = 0; i < tiles.size(); ++i) {
            const auto from = array.begin() + std::ptrdiff_t(before[i].first * each);
            std::copy(from, from + std::ptrdiff_t(counts[i] * each),
                      array.begin() + std::ptrdiff_t(tiles[i].first * each));
        }
    };
    run(parallel, 3, [&](std::size_t task) {
        if (task == 0) {
            close_up(nodes, 1);
            nodes.shrink(next);
        } else if (task == 1) {
            close_up(rings, 1);
            rings.shrink(next);
        } else {
            close_up(keys, 1);
            keys.shrink(next);
            close_up(more, std::size_t(more_channels));
            more.resize(std::size_t(next) * std::size_t(more_channels));
            more.shrink_to_fit();
        }
    });
    run(parallel, tiles.size(), [&](std::size_t i) {
        for (Index v = before[i].first; v < before[i].last; ++v)
            number_of[v] += tiles[i].first;
    });
    run(parallel, tiles.size(), [&](std::size_t i) {
        for (Index v = tiles[i].first; v < tiles[i].last; ++v)
            for (int j = 0; j < nodes[v].degree; ++j) {
                Index& q = rings[v].v[std::size_t(j)];
                q = q == kGhost ? kGhost : number_of[q];
            }
    });
    merge_small_tiles();
}

void WorkingMesh::merge_small_tiles()
{
    while (tiles.size() > 1 && m_alive / Index(tiles.size()) < kSmallTile)
        merge_tiles();
}

void WorkingMesh::merge_tiles()
{
    // Tiles are in Morton order: the four children of a coarser tile follow each other.
    std::vector<Tile> merged;
    for (const Tile& tile : tiles) {
        const std::uint32_t x = tile.x / 2, y = tile.y / 2;
        if (!merged.empty() && merged.back().x == x && merged.back().y == y)
            merged.back().last = tile.last;
        else
            merged.push_back({ tile.first, tile.last, x, y });
    }
    tiles = std::move(merged);
    m_blocks_per_tile *= 2;
}

}  // namespace PIMG_ABI
}  // namespace pimg
