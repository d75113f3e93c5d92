// SPDX-License-Identifier: BSD-3-Clause
// Synthesis with details a filter makes up as it goes.
#pragma once

#include <pimg/bands.h>

namespace pimg {

/// One pass from coarse to fine over the splits [first, levels): `values` holds the vertices of level `first` and receives
/// those of the finest; detail_of(i) returns the detail of split i. Like pimg::sweep(), but the base is the caller's.
template<class DetailOf>
void sweep_from(const Hierarchy& hierarchy, Level first, float* values, DetailOf&& detail_of)
{
    const Index base = hierarchy.base_vertices();
    const Stencil* stencil = hierarchy.stencils.data();
    const Level levels = hierarchy.levels();
    for (Level i = first; i < levels; ++i) {
        const Stencil& k = stencil[i];
        const float s = values[k.s];
        const Detail d = detail_of(i);
        const float t = s + (k.wat * (values[k.at] - s) + k.wbt * (values[k.bt] - s)) + d.t;
        values[base + i] = s + (k.wau * (values[k.au] - s) + k.wbu * (values[k.bu] - s)) + d.u;
        values[k.s] = t;
    }
}

}  // namespace pimg
