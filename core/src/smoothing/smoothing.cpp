// SPDX-License-Identifier: BSD-3-Clause
#include <pimg/detail/parallel.h>
#include <pimg/smoothing.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include <pimg/bands.h>
#include <pimg/detail/diffusion.h>
#include <pimg/detail/lanes.h>
#include <pimg/detail/piece_means.h>
#include <pimg/detail/sweep_plan.h>

namespace pimg {
inline namespace PIMG_ABI {

namespace {

/// Pixels a deviation of `strength` must cover to count as a feature. Chosen by eye; more smooths away larger things.
constexpr float kFeaturePixels = 8.0f;

// The next four are measured: the table of docs/smoothing.md has them beside other values.
constexpr float kStartShare = 0.85f;      ///< of what the sweep removed, in the picture that diffuses
constexpr float kContrastShare = 0.7f;    ///< contrast that stops diffusion, as a share of the strength
constexpr int kSteps = 6;                 ///< of diffusion guided by the features
constexpr int kOwnSteps = 3;              ///< and then by what came out of that
constexpr float kLeastStrength = 1e-17f;  ///< its square is still a normal float

/// Share of a deviation that stays: 0 well below the tolerance, 1 well above, a half at it. `square` is the
/// squared ratio of both.
float kept_share(float square)
{
    return 1.0f - 1.0f / (1.0f + square * square);
}

/// Vertex values with the channels of a vertex side by side.
template<int C>
class FeatureSweep {
public:
    /// `tolerance`: deviation of a single pixel of which half stays.
    FeatureSweep(const SweepPlan& plan, const SmoothingSource& source, float tolerance)
        : m_plan(plan),
          m_source(source),
          m_scale(1.0f / (tolerance * tolerance) / float(C)),
          m_values(new float[plan.places() * kLanes<C>])
    {
        // All places that are read have been written before, but where there is no vertex.
        if (plan.levels() + source.means[0].base.size() < plan.places())
            std::fill_n(m_values.get(), plan.places() * kLanes<C>, 0.0f);
    }

    void run(const ParallelFor& parallel);
    const float* values() const { return m_values.get(); }

private:
    using Sample = Lanes<C>;
    Sample at(Index place) const { return lanes_at<C>(m_values.get(), place); }
    void place(Index place, Sample predicted, Sample mean, float evidence);

    const SweepPlan& m_plan;
    const SmoothingSource& m_source;
    float m_scale;
    std::unique_ptr<float[]> m_values;
};

template<int C>
void FeatureSweep<C>::place(Index place, Sample predicted, Sample mean, float evidence)
{
    const Sample off = mean - predicted, squares = off * off;
    float square = 0.0f;
    for (int c = 0; c < C; ++c)
        square += lane<C>(squares, c);
    const float share = kept_share(square * m_scale * evidence);
    set_lanes<C>(predicted + in_all_lanes<C>(share) * off, place, m_values.get());
}

template<int C>
void FeatureSweep<C>::run(const ParallelFor& parallel)
{
    const SplitPair* means[C];
    for (int c = 0; c < C; ++c)
        means[c] = m_source.means[std::size_t(c)].splits.data();
    for (Index v = 0; v < Index(m_source.means[0].base.size()); ++v)
        set_lanes<C>(lanes_of<C>([&](int c) { return m_source.means[std::size_t(c)].base[v]; }), m_plan.base_place(v),
                     m_values.get());
    m_plan.for_splits(parallel, [&](Level first, Level last) {
        m_plan.visit_splits(first, last, [&](Level i, const PlannedSplit& k) {
            constexpr Level kAhead = 128;  // splits
            for (const SplitPair* of_channel : means)
                __builtin_prefetch(of_channel + i + kAhead);
            __builtin_prefetch(m_source.evidence.data() + i + kAhead);
            const SplitPair evidence = m_source.evidence[i];
            const Sample s = at(k.s), t = interpolate_lanes<C>(s, at(k.at), at(k.bt), k.wat, k.wbt),
                         u = interpolate_lanes<C>(s, at(k.au), at(k.bu), k.wau, k.wbu);
            place(k.s, t, lanes_of<C>([&](int c) { return means[c][i].t; }), evidence.t);
            place(k.u, u, lanes_of<C>([&](int c) { return means[c][i].u; }), evidence.u);
        });
    });
}

template<int C>
void run_sweep(const Hierarchy& hierarchy, const SmoothingSource& source, const SmoothingOptions& options,
               Channels& features)
{
    const SweepPlan unplanned = SweepPlan::unplanned(hierarchy);
    const SweepPlan& plan = source.plan != nullptr ? *source.plan : unplanned;
    FeatureSweep<C> sweep(plan, source, kFeaturePixels * std::max(options.strength, kLeastStrength));
    sweep.run(options.parallel);
    features.resize(C);
    float* samples[C];
    for (int c = 0; c < C; ++c) {
        features[std::size_t(c)].resize(hierarchy.mesh_pixels());
        samples[c] = features[std::size_t(c)].data();
    }
    plan.scatter_channels<C>(hierarchy, sweep.values(), samples, options.parallel);
}

void sweep_features(const Hierarchy& hierarchy, const SmoothingSource& source, const SmoothingOptions& options,
                    Channels& features)
{
    switch (source.samples.size()) {
    case 1:
        return run_sweep<1>(hierarchy, source, options, features);
    case 2:
        return run_sweep<2>(hierarchy, source, options, features);
    case 3:
        return run_sweep<3>(hierarchy, source, options, features);
    default:
        return run_sweep<4>(hierarchy, source, options, features);
    }
}

}  // namespace

std::size_t SmoothingSource::memory() const
{
    std::size_t total = evidence.capacity() * sizeof(SplitPair);
    for (const std::vector<float>& channel : samples)
        total += channel.capacity() * sizeof(float);
    for (const PieceMeans& m : means)
        total += m.base.capacity() * sizeof(float) + m.splits.capacity() * sizeof(SplitPair);
    return total;
}

SmoothingSource analyse_for_smoothing(const Hierarchy& hierarchy, Channels samples)
{
    SmoothingSource source;
    source.evidence = piece_sizes(hierarchy);
    for (SplitPair& d : source.evidence)
        d = { d.t * d.t, d.u * d.u };
    for (const std::vector<float>& channel : samples)
        source.means.push_back(piece_means(hierarchy, channel.data()));
    source.samples = std::move(samples);
    return source;
}

void feature_sweep(const Hierarchy& hierarchy, const SmoothingSource& source, float strength, Channels& features)
{
    SmoothingOptions options;
    options.strength = strength;
    sweep_features(hierarchy, source, options, features);
}

void smooth(const Hierarchy& hierarchy, const SmoothingSource& source, const SmoothingOptions& options,
            Channels& result)
{
    if (!(options.strength > 0.0f)) {
        result = source.samples;
        return;
    }
    Channels features, guided;
    sweep_features(hierarchy, source, options, features);
    DiffusionOptions diffusion;
    diffusion.width = hierarchy.mesh_width();
    diffusion.height = hierarchy.mesh_height();
    diffusion.contrast = kContrastShare * std::max(options.strength, kLeastStrength);
    diffusion.steps = kSteps;
    diffusion.parallel = options.parallel;
    diffusion.share = kStartShare;
    diffuse(features, diffusion, source.samples, guided);
    diffusion.steps = kOwnSteps;
    diffusion.share = 1.0f;
    result = std::move(features);  // its memory
    diffuse(guided, diffusion, guided, result);
}

namespace {

/// Share of the detail that is amplified at each pixel of row y, see enhance(). `scale`: of the squared differences.
std::vector<float> share_off_edges(const Channels& smoothed, int width, int height, int y, float scale)
{
    const std::size_t n = std::size_t(width), at = std::size_t(y) * n;
    const std::size_t above = y > 0 ? at - n : at, below = y + 1 < height ? at + n : at;
    std::vector<float> share(n, 0.0f);
    for (const std::vector<float>& z : smoothed)
        for (std::size_t x = 0; x < n; ++x) {
            const float dx = z[at + std::min(x + 1, n - 1)] - z[at + std::max<std::size_t>(x, 1) - 1];
            const float dy = z[below + x] - z[above + x];
            share[x] += dx * dx + dy * dy;
        }
    for (float& s : share)
        s = 1.0f / ((1.0f + scale * s) * (1.0f + scale * s));
    return share;
}

}  // namespace

void enhance(const Hierarchy& hierarchy, const SmoothingSource& source, const SmoothingOptions& options, float gain,
             Channels& result)
{
    Channels smoothed;
    smooth(hierarchy, source, options, smoothed);
    result.resize(source.samples.size());
    for (std::size_t c = 0; c < result.size(); ++c)
        result[c].resize(source.samples[c].size());
    // Differences over two pixels, twice the gradient: their square holds the factor 4.
    const float strength = std::max(options.strength, kLeastStrength);
    const float scale = 1.0f / (strength * strength * float(result.size()));
    const int width = hierarchy.mesh_width(), height = hierarchy.mesh_height();
    run(options.parallel, std::size_t(height), [&](std::size_t y) {
        const std::vector<float> share = share_off_edges(smoothed, width, height, int(y), scale);
        for (std::size_t c = 0; c < result.size(); ++c) {
            float* to = &result[c][y * share.size()];
            const float *source_row = &source.samples[c][y * share.size()], *from = &smoothed[c][y * share.size()];
            for (std::size_t x = 0; x < share.size(); ++x)
                to[x] = source_row[x] + (gain - 1.0f) * share[x] * (source_row[x] - from[x]);
        }
    });
}

float noise_level(const Channels& samples, int width, int height)
{
    double sum = 0.0;
    for (const std::vector<float>& z : samples) {
        std::vector<float> differences;
        for (std::size_t y = 0; y + 1 < std::size_t(height); ++y)
            for (std::size_t i = y * std::size_t(width); i + 1 < (y + 1) * std::size_t(width); ++i) {
                const std::size_t below = i + std::size_t(width);
                differences.push_back(std::fabs((z[i] - z[i + 1]) - (z[below] - z[below + 1])));
            }
        if (differences.empty())
            return 0.0f;
        const auto middle = differences.begin() + std::ptrdiff_t(differences.size() / 2);
        std::nth_element(differences.begin(), middle, differences.end());
        // The median of |normal| is 0.6745 sigma, and the difference of four samples has twice their sigma.
        const double sigma = double(*middle) / (2.0 * 0.6745);
        sum += sigma * sigma;
    }
    return samples.empty() ? 0.0f : float(std::sqrt(sum / double(samples.size())));
}

}  // namespace PIMG_ABI
}  // namespace pimg
