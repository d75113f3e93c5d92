// SPDX-License-Identifier: BSD-3-Clause
// What is drawn over a picture: edges of a mesh, and the dual piece of a place with the splits it came from.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include <pimg/dual_pieces.h>

#include "render/frame.h"

namespace pimgview {

/// A line between two places, in pixels of the file; (0, 0) is the corner of the first pixel, not its centre.
struct Line {
    float x0, y0, x1, y1;
};

/// Edges of the mesh with `vertices` vertices that touch a region.
struct MeshLines {
    static constexpr std::size_t kMost = 30000;  ///< more are a solid surface in a window; an estimate

    std::shared_ptr<const pimg::ProgressiveImage> image;  ///< the image that the mesh belongs to
    pimg::Index vertices = 0;
    Region region;
    bool too_many = false;  ///< there are more than kMost, and none are given
    std::vector<Line> lines;
};

/// `factor` is that of the rung the image was built from. An error of a damaged hierarchy gives no lines.
MeshLines mesh_lines(const std::shared_ptr<const pimg::ProgressiveImage>& image, pimg::Index vertices, int factor,
                     const Region& region);

/// The dual pieces of one level.
struct PieceMap {
    std::shared_ptr<const pimg::ProgressiveImage> image;
    pimg::Index vertices = 0;
    int factor = 1;
    std::shared_ptr<const pimg::DualPieces> pieces;
    std::vector<pimg::Index> labels;
};

/// `before`, which may be null, is another level's: what does not depend on the level is taken from it.
std::shared_ptr<const PieceMap> piece_map(const std::shared_ptr<const pimg::ProgressiveImage>& image,
                                          pimg::Index vertices, int factor, const PieceMap* before);

/// One piece.
struct Piece {
    pimg::Index vertex = 0, pixels = 0;
    std::vector<Line> outline;
    std::vector<std::string> history;  ///< the splits its vertex came from, the last one first
};

/// The piece that holds a pixel of the file; false outside of the picture.
bool piece_at(const PieceMap& map, int x, int y, Piece& piece);

}  // namespace pimgview
