// SPDX-License-Identifier: BSD-3-Clause
#include <pimg/detail/piece_means.h>
#include <pimg/detail/stop.h>

namespace pimg {
inline namespace PIMG_ABI {

namespace {

/// Size of the piece of every vertex of the finest mesh: its own pixel, and of those between vertices the share that
/// interpolation gives it.
std::vector<float> finest_sizes(const Hierarchy& h)
{
    std::vector<float> raster(h.mesh_pixels(), 1.0f), sizes(h.vertices());
    for (const PixelStencil& k : h.between) {
        raster[k.a] += 1.0f - k.wb - k.wc;
        raster[k.b] += k.wb;
        raster[k.c] += k.wc;
    }
    for (Index v = 0; v < h.vertices(); ++v)
        sizes[v] = raster[h.pixels[v]];
    return sizes;
}

/// Sums of the samples over the same pieces.
std::vector<float> finest_sums(const Hierarchy& h, const float* samples)
{
    std::vector<float> raster(samples, samples + h.mesh_pixels()), sums(h.vertices());
    for (const PixelStencil& k : h.between) {
        raster[k.a] += (1.0f - k.wb - k.wc) * samples[k.pixel];
        raster[k.b] += k.wb * samples[k.pixel];
        raster[k.c] += k.wc * samples[k.pixel];
    }
    for (Index v = 0; v < h.vertices(); ++v)
        sums[v] = raster[h.pixels[v]];
    return sums;
}

}  // namespace

std::vector<SplitPair> piece_sizes(const Hierarchy& h)
{
    std::vector<float> size = finest_sizes(h);
    std::vector<SplitPair> sizes(h.levels());
    const Index base = h.base_vertices();
    for (Level i = h.levels(); i-- > 0;) {
        if (i % kBetweenStops == 0)
            stop_point();
        float& s = size[h.stencils[i].s];
        sizes[i] = { s, size[base + i] };
        s += size[base + i];
    }
    return sizes;
}

PieceMeans piece_means(const Hierarchy& h, const float* samples)
{
    struct Piece {
        float mean, size;
    };
    const Index base = h.base_vertices();
    const std::vector<float> sizes = finest_sizes(h), sums = finest_sums(h, samples);
    std::vector<Piece> pieces(h.vertices());
    for (Index v = 0; v < h.vertices(); ++v)
        pieces[v] = { sums[v] / sizes[v], sizes[v] };
    PieceMeans means;
    means.splits.resize(h.levels());
    for (Level i = h.levels(); i-- > 0;) {
        if (i % kBetweenStops == 0)
            stop_point();
        Piece& s = pieces[h.stencils[i].s];
        const Piece u = pieces[base + i];
        means.splits[i] = { s.mean, u.mean };
        s.size += u.size;
        s.mean += (u.mean - s.mean) * (u.size / s.size);
    }
    means.base.resize(base);
    for (Index v = 0; v < base; ++v)
        means.base[v] = pieces[v].mean;
    return means;
}

}  // namespace PIMG_ABI
}  // namespace pimg
