// SPDX-License-Identifier: BSD-3-Clause
// The intensities of a progressive image: for one channel, the values of the base mesh and the
// details (dt, du) of every split (paper, section 3.3). Any channel can be analysed onto an
// existing hierarchy; a filter is a gain on the details; synthesis is one linear sweep.
#pragma once

#include <algorithm>
#include <vector>

#include <pimg/hierarchy.h>

namespace pimg {

/// Details of one split: intensity minus what the coarser mesh predicts there.
struct Detail {
    float t, u;
};

/// One channel on a hierarchy. `base[v]` is the value of base vertex v, and `details[i]` belongs to split i. `residual`
/// is the finest band: for each mesh pixel, the channel minus the Gouraud image of the finest mesh. It is empty, which
/// means 0 everywhere, when every pixel is a vertex.
struct Bands {
    std::vector<float> base;
    std::vector<Detail> details;
    std::vector<float> residual;

    /// Largest |detail| of all splits, 0 for none.
    float largest_detail() const;
};

/// Analyses channels onto a hierarchy. Each holds one finite value per mesh pixel, row-major (to_mesh_pixels()).
/// As for the guide, the value of a coarse vertex preserves the volume under the surface, so every M_i
/// has the channel's mean; that takes the topology of every level, so the splits are replayed, once for all
/// channels. Synthesis with untouched details returns the samples to within one rounding.
/// Fails only on a damaged hierarchy.
Status analyse(const Hierarchy& hierarchy, const std::vector<const float*>& channels, std::vector<Bands>& bands,
               const ParallelFor& parallel = {});

/// Copies a picture's samples (row-major, width x height) to mesh pixels: the same, but for pictures one
/// pixel wide or high, whose only column or row is repeated.
std::vector<float> to_mesh_pixels(const Hierarchy& hierarchy, const float* samples);

/// Makes level `level` the base mesh: the splits before it are forgotten.
Status rebase(Hierarchy& hierarchy, std::vector<Bands>& bands, Level level, const ParallelFor& parallel = {});

/// Values of all vertices of level `level`, indexed by vertex number.
std::vector<float> values_at(const Hierarchy& hierarchy, const Bands& bands, Level level);

/// One pass from coarse to fine over the first `levels` splits: values[v] of every vertex of that level, where
/// gain(i, detail) returns the detail to use for split i. `values` holds base_vertices() + levels floats.
template<class Gain>
void sweep(const Hierarchy& hierarchy, const Bands& bands, float* values, Level levels, Gain&& gain);

/// The part of sweep() for the splits [first, last): `values` holds the vertices of level `first` and receives those of
/// level `last`; detail_of(i) returns the detail of split i.
template<class DetailOf>
void sweep_splits(const Hierarchy& hierarchy, Level first, Level last, float* values, DetailOf&& detail_of);

/// sweep() at the finest level without a gain, written to the mesh pixels (row-major), and the residual.
void synthesise(const Hierarchy& hierarchy, const Bands& bands, float* samples, const ParallelFor& parallel = {});

/// Moves values of the finest level from vertex order to mesh pixels (row-major), and interpolates the
/// pixels between them: the Gouraud image of the finest mesh.
void scatter(const Hierarchy& hierarchy, const float* values, float* samples, const ParallelFor& parallel = {});

/// The second half of scatter(): interpolates the pixels between the vertices. `samples` holds those of the vertices.
void interpolate_between(const Hierarchy& hierarchy, float* samples, const ParallelFor& parallel = {});

/// Adds gain(pixel, residual) to the samples of all mesh pixels; nothing without a residual.
template<class Gain>
void add_residual(const Bands& bands, float* samples, Gain&& gain);

/// Turns details that hold the true values of t and u into details proper, and fills the residual from the channel's
/// samples (per mesh pixel). Done against the values synthesis will have at each level, so that no
/// rounding adds up over the levels.
void values_to_details(const Hierarchy& hierarchy, const float* samples, Bands& bands);

template<class Gain>
void sweep(const Hierarchy& hierarchy, const Bands& bands, float* values, Level levels, Gain&& gain)
{
    std::copy(bands.base.begin(), bands.base.end(), values);
    const Detail* detail = bands.details.data();
    sweep_splits(hierarchy, 0, levels, values, [&](Level i) { return gain(i, detail[i]); });
}

template<class DetailOf>
void sweep_splits(const Hierarchy& hierarchy, Level first, Level last, float* values, DetailOf&& detail_of)
{
    constexpr Level kAhead = 24;
    const Stencil* stencil = hierarchy.stencils.data();
    float* made = values + hierarchy.base_vertices();
    for (Level i = first; i < last; ++i) {
        if (i + kAhead < last) {  // where values are is the only thing in no order in memory
            const Stencil& later = stencil[i + kAhead];
            for (const Index v : { later.s, later.at, later.bt, later.au, later.bu })
                __builtin_prefetch(values + v);
        }
        const Stencil& k = stencil[i];
        const float s = values[k.s];
        const Detail d = detail_of(i);
        const float t = s + (k.wat * (values[k.at] - s) + k.wbt * (values[k.bt] - s)) + d.t;
        made[i] = s + (k.wau * (values[k.au] - s) + k.wbu * (values[k.bu] - s)) + d.u;
        values[k.s] = t;
    }
}

template<class Gain>
void add_residual(const Bands& bands, float* samples, Gain&& gain)
{
    const std::size_t n = bands.residual.size();
    for (std::size_t p = 0; p < n; ++p)
        samples[p] += gain(Index(p), bands.residual[p]);
}

}  // namespace pimg
