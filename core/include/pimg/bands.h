// SPDX-License-Identifier: BSD-3-Clause
// The intensities of a progressive image (paper, section 3.3): for one channel, the values of the base mesh and the
// details (dt, du) of every split. analyse() finds them for any channel on an existing hierarchy. A filter multiplies
// the details by a gain. synthesise() makes pixels of them again, in one pass over the splits.
#pragma once

#include <algorithm>
#include <vector>

#include <hwy/cache_control.h>

#include <pimg/hierarchy.h>

namespace pimg {
inline namespace PIMG_ABI {

/// The details of one split: the intensity of t minus what the coarser mesh predicts at its place, and the same for u.
struct Detail {
    float t, u;
};

/// One channel on a hierarchy, in the channel's own units. `base[v]` is the value of base vertex v, and `details[i]`
/// belongs to split i. `residual` is the finest band: for each mesh pixel, the channel minus what the finest mesh
/// interpolates there. It is empty when every pixel is a vertex, and then counts as 0 everywhere.
struct PIMG_EXPORT Bands {
    std::vector<float> base;
    std::vector<Detail> details;
    std::vector<float> residual;

    /// The largest absolute value of all details; 0 if there are none.
    float largest_detail() const;
};

/// Analyses channels onto a hierarchy: bands[c] receives the base values, details and residual of channels[c]. Each
/// channel holds one finite value per mesh pixel, row-major (to_mesh_pixels()). Values of coarse vertices preserve the
/// volume under the surface, as they do for the guide, so every M_i has the channel's mean. This takes the mesh of every
/// level; all splits are replayed, once for all channels together. Synthesis with unchanged details returns the samples
/// to within one rounding. Fails only on a damaged hierarchy.
PIMG_EXPORT Status analyse(const Hierarchy& hierarchy, const std::vector<const float*>& channels,
                           std::vector<Bands>& bands, const ParallelFor& parallel = {});

/// Copies a picture's samples (row-major, width x height) to mesh pixels (row-major, mesh_width() x mesh_height()). They
/// are the same samples, but for pictures one pixel wide or high, whose only column or row is repeated.
PIMG_EXPORT std::vector<float> to_mesh_pixels(const Hierarchy& hierarchy, const float* samples);

/// Makes M_i of level i = `level` the base mesh, and drops the splits before it. `level` is 0 .. levels(). Fails only on
/// a damaged hierarchy; nothing is then changed.
PIMG_EXPORT Status rebase(Hierarchy& hierarchy, std::vector<Bands>& bands, Level level,
                          const ParallelFor& parallel = {});

/// The values of all vertices of M_i of level i = `level`, indexed by vertex number. A level above the finest counts as
/// the finest.
PIMG_EXPORT std::vector<float> values_at(const Hierarchy& hierarchy, const Bands& bands, Level level);

/// Computes the values of all vertices of level `levels`, in one pass from coarse to fine over the first `levels` splits.
/// gain(i, detail) returns the detail to use for split i. `values` has room for base_vertices() + levels floats;
/// values[v] receives the value of vertex v.
template<class Gain>
void sweep(const Hierarchy& hierarchy, const Bands& bands, float* values, Level levels, Gain&& gain);

/// The part of sweep() for the splits [first, last). `values` holds the values of the vertices of level `first`, and
/// afterwards those of level `last`. detail_of(i) returns the detail to use for split i.
template<class DetailOf>
void sweep_splits(const Hierarchy& hierarchy, Level first, Level last, float* values, DetailOf&& detail_of);

/// Makes the channel's samples from its bands, unchanged: sweeps to the finest level, writes the values to the mesh pixels
/// (row-major) and adds the residual.
PIMG_EXPORT void synthesise(const Hierarchy& hierarchy, const Bands& bands, float* samples,
                            const ParallelFor& parallel = {});

/// Writes values of the finest level, one per vertex, to the mesh pixels (row-major), and interpolates the pixels that are
/// no vertex.
PIMG_EXPORT void scatter(const Hierarchy& hierarchy, const float* values, float* samples,
                         const ParallelFor& parallel = {});

/// The second half of scatter(): `samples` holds the values of the pixels that are vertices; the others are interpolated.
PIMG_EXPORT void interpolate_between(const Hierarchy& hierarchy, float* samples, const ParallelFor& parallel = {});

/// Adds gain(pixel, residual) to the sample of every mesh pixel. Does nothing if there is no residual.
template<class Gain>
void add_residual(const Bands& bands, float* samples, Gain&& gain);

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
                hwy::Prefetch(values + v);
        }
        const Stencil& k = stencil[i];
        const SplitPair predicted = predict(k, values);
        const Detail d = detail_of(i);
        made[i] = predicted.u + d.u;
        values[k.s] = predicted.t + d.t;
    }
}

template<class Gain>
void add_residual(const Bands& bands, float* samples, Gain&& gain)
{
    const std::size_t n = bands.residual.size();
    for (std::size_t p = 0; p < n; ++p)
        samples[p] += gain(Index(p), bands.residual[p]);
}

}  // namespace PIMG_ABI
}  // namespace pimg
