// SPDX-License-Identifier: BSD-3-Clause
// What reading and writing the mesh layer have in common: the fields of a split, once.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "mesh_layer/mesh_layer.h"

namespace pimg {
inline namespace PIMG_ABI {

struct LayerOutput {
    static constexpr bool kWriting = true;
    BinaryWriter& stream;
    std::uint32_t number(NumberModel& model, std::uint32_t v)
    {
        model.write(stream, v);
        return v;
    }
};

struct LayerInput {
    static constexpr bool kWriting = false;
    BinaryReader& stream;
    std::uint32_t number(NumberModel& model, std::uint32_t) { return model.read(stream); }
};

template<class Io>
std::int32_t signed_number(Io& io, NumberModel& model, std::int32_t v)
{
    return unfold(io.number(model, fold(v)));
}

/// Lattice coordinate in steps of 2^shift, to nearest.
inline std::int32_t in_steps(std::int32_t v, std::uint32_t shift)
{
    return (v + (1 << shift >> 1)) >> shift;
}

template<class Io>
bool code_geometry(Io& io, MeshModels& models, const MeshLayerHead& head, const Mesh& mesh, const CanonicalRing& ring,
                   LayerSplit& split)
{
    const std::uint32_t shift = head.lattice_shift;
    const Point s = mesh.point(split.s);
    // Whatever a file says stays unsigned until it is known to be a place of the ring.
    const std::uint32_t degree = std::uint32_t(ring.degree);
    const int around = (split.vl - split.vr + ring.degree) % ring.degree;
    const std::uint32_t right = io.number(models.vr[degree], std::uint32_t(split.vr));
    const std::uint32_t steps = io.number(models.vl[degree], std::uint32_t(around));
    if (right >= degree || steps < 1 || steps >= degree)
        return false;
    split.vr = int(right);
    split.vl = int((right + steps) % degree);

    // The edge t -> u, then where its middle is from s.
    const int border = ring.has_ghost();
    const std::size_t size = std::size_t(bit_length(ring.radius(s) >> shift));
    std::int32_t dx = (split.u.x >> shift) - (split.t.x >> shift), dy = (split.u.y >> shift) - (split.t.y >> shift);
    dx = signed_number(io, models.edge[border][2 * size], dx);
    dy = signed_number(io, models.edge[border][2 * size + 1], dy);
    constexpr std::int32_t kFar = 1 << 27;  // beyond any picture, and sums stay in 32 bits
    if (std::abs(dx / 2) >= kFar || std::abs(dy / 2) >= kFar)
        return false;
    const std::size_t length = std::size_t(bit_length(std::uint32_t(std::max(std::abs(dx), std::abs(dy)))));
    const std::int32_t cx = in_steps(s.x, shift) - (dx >> 1), cy = in_steps(s.y, shift) - (dy >> 1);
    const std::int32_t mx = signed_number(io, models.middle[border][2 * length], (split.t.x >> shift) - cx);
    const std::int32_t my = signed_number(io, models.middle[border][2 * length + 1], (split.t.y >> shift) - cy);
    if (std::abs(mx / 2) >= kFar || std::abs(my / 2) >= kFar)
        return false;
    const std::int64_t tx = std::int64_t(cx) + mx, ty = std::int64_t(cy) + my;
    const auto lattice = [&](std::int64_t x, std::int64_t y, Point& p) {
        if (x < 0 || y < 0 || x > mesh.extent().x >> shift || y > mesh.extent().y >> shift)
            return false;
        p = { std::int32_t(x) * (1 << shift), std::int32_t(y) * (1 << shift) };
        return true;
    };
    return lattice(tx, ty, split.t) && lattice(tx + dx, ty + dy, split.u);
}

/// Appends the values of u and replaces those of s by t's. `targets` are, when writing, the wanted values of t and u of
/// each channel in turn.
template<class Io>
void code_values(Io& io, MeshModels& models, const MeshLayerHead& head, MeshLayer& layer, const CanonicalRing& ring,
                 const LayerSplit& split, const float* targets)
{
    const Point s = layer.mesh.point(split.s);
    const IntegerStencil stencils[2] = { integer_stencil(split.t, s, ring, split.vr),
                                         integer_stencil(split.u, s, ring, split.vr) };
    int before[2] = { 0, 0 };
    for (std::size_t c = 0; c < layer.values.size(); ++c) {
        std::vector<std::int32_t>& z = layer.values[c];
        const std::uint32_t shift = head.value_shifts[c];
        std::int32_t fine[2];
        for (std::size_t k = 0; k < 2; ++k) {
            const std::int32_t predicted = stencils[k].predict(z, split.s);
            std::int32_t detail = 0;
            if constexpr (Io::kWriting)
                detail = std::int32_t(std::lround(std::ldexp(targets[2 * c + k] - float(predicted), -int(shift))));
            const std::uint32_t folded = io.number(models.detail[8 * c + 4 * k + std::size_t(before[k])], fold(detail));
            before[k] = std::min(3, bit_length(folded) / 2);
            const std::int64_t value = predicted + std::int64_t(unfold(folded)) * (1 << shift);
            fine[k] = std::int32_t(std::clamp<std::int64_t>(value, kMeshValueLow, kMeshValueHigh));
        }
        z[split.s] = fine[0];
        z.push_back(fine[1]);
    }
}

}  // namespace PIMG_ABI
}  // namespace pimg
