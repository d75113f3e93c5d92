// SPDX-License-Identifier: BSD-3-Clause
// Analysis of further channels: replays the splits to the finest level, then undoes them one by one.
#include <pimg/bands.h>

#include <algorithm>

namespace pimg {

namespace {

/// The volume equation of one collapse, solved for the intensity of s: a weighted mean of t, u and their ring,
///     z_s = z_t + sum of weight (z - z_t).
/// The weights are areas, so they hold for every channel.
struct VolumeStencil {
    int size = 0;
    Index vertex[2 * kMaxDegree];
    float weight[2 * kMaxDegree];

    void add(Index v, double w)
    {
        vertex[size] = v;
        weight[size++] = float(w);
    }
};

/// For the split of s into t (number s in `fine`) and u; `coarse` is where s will be.
VolumeStencil volume_stencil(const Mesh& fine, Index s, Index u, Point coarse)
{
    const Point t = fine.point(s), pu = fine.point(u);
    // Twice the area each ring vertex loses (old fans minus new star), and the whole star's.
    VolumeStencil stencil;
    double ring_share[2 * kMaxDegree], of_u = 0.0, star = 0.0;
    Index ring[2 * kMaxDegree];
    int n = 0;
    const auto slot = [&](Index v) {
        const int at = int(std::find(ring, ring + n, v) - ring);
        if (at == n) {
            ring[n] = v;
            ring_share[n++] = 0.0;
        }
        return at;
    };
    const auto add_fan = [&](Index centre, Point p, Index other) {
        const RingView r = fine.ring(centre);
        for (int j = 0; j < r.degree; ++j) {
            const Index a = r[j], b = r[j + 1 < r.degree ? j + 1 : 0];
            if (a == kGhost || b == kGhost)
                continue;
            const bool shared = a == other || b == other;
            if (shared && centre == u)
                continue;  // counted in the fan of t
            const double before = double(doubled_area(p, fine.point(a), fine.point(b)));
            if (centre == u || shared)
                of_u += before;
            const double after = shared ? 0.0 : double(doubled_area(coarse, fine.point(a), fine.point(b)));
            star += after;
            if (a != other)
                ring_share[slot(a)] += before - after;
            if (b != other)
                ring_share[slot(b)] += before - after;
        }
    };
    add_fan(s, t, u);
    add_fan(u, pu, s);
    for (int i = 0; i < n; ++i)
        stencil.add(ring[i], ring_share[i] / star);
    stencil.add(u, of_u / star);
    return stencil;
}

}  // namespace

Status analyse(const Hierarchy& h, const std::vector<const float*>& channels, std::vector<Bands>& bands)
{
    Mesh mesh;
    std::vector<Point> coarse(h.levels());
    Status status = refine(h, h.levels(), mesh, &coarse);
    if (!status)
        return status;
    const Index base = h.base_vertices();
    std::vector<std::vector<float>> values(channels.size(), std::vector<float>(h.vertices()));
    bands.assign(channels.size(), {});
    for (std::size_t c = 0; c < channels.size(); ++c) {
        bands[c].details.resize(h.levels());
        for (Index v = 0; v < h.vertices(); ++v)
            values[c][v] = channels[c][h.pixels[v]];
    }
    for (Level i = h.levels(); i-- > 0;) {
        const Index s = h.splits[i].s, u = base + i;
        const VolumeStencil stencil = volume_stencil(mesh, s, u, coarse[i]);
        for (std::size_t c = 0; c < channels.size(); ++c) {
            float* z = values[c].data();
            float change = 0.0f;
            for (int k = 0; k < stencil.size; ++k)
                change += stencil.weight[k] * (z[stencil.vertex[k]] - z[s]);
            bands[c].details[i] = { z[s], z[u] };
            z[s] += change;
        }
        if (!mesh.collapse(s, coarse[i]))
            return Status::failure("hierarchy: split " + std::to_string(i) + " cannot be undone");
    }
    for (std::size_t c = 0; c < channels.size(); ++c) {
        bands[c].base.assign(values[c].begin(), values[c].begin() + base);
        values_to_details(h, channels[c], bands[c]);
    }
    return {};
}

}  // namespace pimg
