// SPDX-License-Identifier: BSD-3-Clause
#include <pimg/piece_means.h>

namespace pimg {

std::vector<Detail> piece_sizes(const Hierarchy& h)
{
    std::vector<float> size(h.vertices(), 1.0f);
    std::vector<Detail> sizes(h.levels());
    const Index base = h.base_vertices();
    for (Level i = h.levels(); i-- > 0;) {
        float& s = size[h.stencils[i].s];
        sizes[i] = { s, size[base + i] };
        s += size[base + i];
    }
    return sizes;
}

Bands piece_means(const Hierarchy& h, const float* samples)
{
    struct Piece {
        float mean, size;
    };
    const Index base = h.base_vertices();
    std::vector<Piece> pieces(h.vertices());
    for (Index v = 0; v < h.vertices(); ++v)
        pieces[v] = { samples[h.pixels[v]], 1.0f };
    Bands means;
    means.details.resize(h.levels());
    for (Level i = h.levels(); i-- > 0;) {
        Piece& s = pieces[h.stencils[i].s];
        const Piece u = pieces[base + i];
        means.details[i] = { s.mean, u.mean };
        s.size += u.size;
        s.mean += (u.mean - s.mean) * (u.size / s.size);
    }
    means.base.resize(base);
    for (Index v = 0; v < base; ++v)
        means.base[v] = pieces[v].mean;
    return means;
}

}  // namespace pimg
