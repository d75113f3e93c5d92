// SPDX-License-Identifier: BSD-3-Clause
#include "display/overlay.h"

#include <algorithm>
#include <tuple>

#include <pimg/detail/format.h>

namespace pimgview {

namespace {

using pimg::Index;

/// Pixels by which a hierarchy reaches beyond the left and upper sides of its picture, if sides meet.
std::pair<int, int> margins_of(const pimg::ProgressiveImage& image)
{
    return { image.spec().x - image.source().spec().x, image.spec().y - image.source().spec().y };
}

bool touches(const Line& line, const Region& region)
{
    return std::max(line.x0, line.x1) >= float(region.x0) && std::min(line.x0, line.x1) <= float(region.x1)
        && std::max(line.y0, line.y1) >= float(region.y0) && std::min(line.y0, line.y1) <= float(region.y1);
}

}  // namespace

MeshLines mesh_lines(const std::shared_ptr<const pimg::ProgressiveImage>& image, Index vertices, int factor,
                     const Region& region)
{
    MeshLines result { image, vertices, region, false, {} };
    const pimg::Hierarchy& hierarchy = image->hierarchy();
    pimg::Mesh mesh;
    if (!pimg::refine(hierarchy, hierarchy.level_of_vertices(double(vertices)), mesh))
        return result;
    const float unit = float(factor) / float(pimg::kSubpixels);
    const auto [left, up] = margins_of(*image);
    const float x0 = (0.5f - float(left)) * float(factor), y0 = (0.5f - float(up)) * float(factor);
    for (Index v = 0; v < mesh.size(); ++v)
        for (const Index other : mesh.ring(v)) {
            if (other == pimg::kGhost || other < v)
                continue;
            const pimg::Point a = mesh.point(v), b = mesh.point(other);
            const Line line { float(a.x) * unit + x0, float(a.y) * unit + y0, float(b.x) * unit + x0,
                              float(b.y) * unit + y0 };
            if (!touches(line, region))
                continue;
            if (result.lines.size() == MeshLines::kMost) {
                result.lines.clear();
                result.too_many = true;
                return result;
            }
            result.lines.push_back(line);
        }
    return result;
}

std::shared_ptr<const PieceMap> piece_map(const std::shared_ptr<const pimg::ProgressiveImage>& image, Index vertices,
                                          int factor, const PieceMap* before)
{
    auto map = std::make_shared<PieceMap>();
    map->image = image;
    map->vertices = vertices;
    map->factor = factor;
    const pimg::Hierarchy& hierarchy = image->hierarchy();
    if (before != nullptr && before->image == image)
        map->pieces = before->pieces;
    else {
        auto pieces = std::make_shared<pimg::DualPieces>();
        if (!pimg::DualPieces::from_hierarchy(hierarchy, *pieces))
            return nullptr;
        map->pieces = pieces;
    }
    map->labels = map->pieces->labels(hierarchy.level_of_vertices(double(vertices)));
    return map;
}

bool piece_at(const PieceMap& map, int x, int y, Piece& piece)
{
    const int width = map.pieces->width(), height = map.pieces->height(), factor = map.factor;
    const OIIO::ImageSpec& shown = map.image->spec();
    if (x < 0 || y < 0 || x / factor >= shown.width || y / factor >= shown.height)
        return false;
    const auto [left, up] = margins_of(*map.image);
    const auto label = [&](int u, int v) {
        return u < 0 || v < 0 || u >= width || v >= height
            ? pimg::kGhost
            : map.labels[std::size_t(v) * std::size_t(width) + std::size_t(u)];
    };
    piece.vertex = label(x / factor + left, y / factor + up);
    const pimg::DualPieces::Run run = map.pieces->run_at_birth(piece.vertex);
    for (const Index pixel : run) {
        const int u = int(pixel) % width, v = int(pixel) / width;
        if (label(u, v) != piece.vertex)
            continue;  // belongs to another piece by now
        ++piece.pixels;
        const float l = float((u - left) * factor), t = float((v - up) * factor), r = l + float(factor),
                    b = t + float(factor);
        for (const auto& [du, dv, line] :
             { std::tuple(-1, 0, Line { l, t, l, b }), std::tuple(1, 0, Line { r, t, r, b }),
               std::tuple(0, -1, Line { l, t, r, t }), std::tuple(0, 1, Line { l, b, r, b }) })
            if (label(u + du, v + dv) != piece.vertex)
                piece.outline.push_back(line);
    }
    constexpr std::size_t kAncestors = 8;  // lines of text; nobody reads more
    const pimg::Hierarchy& hierarchy = map.image->hierarchy();
    Index v = piece.vertex;
    while (v >= hierarchy.base_vertices() && piece.history.size() < kAncestors) {
        const Index split = v - hierarchy.base_vertices();
        const Index parent = hierarchy.splits[split].s;
        piece.history.push_back(pimg::format("vertex {}: split {} of {}, which removes an error of {:.3g}", v, split,
                                             parent, hierarchy.costs[split]));
        v = parent;
    }
    if (v < hierarchy.base_vertices())
        piece.history.push_back(pimg::format("vertex {}: of the base mesh", v));
    return true;
}

}  // namespace pimgview
