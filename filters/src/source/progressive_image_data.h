// SPDX-License-Identifier: BSD-3-Clause
// What the filters share of a progressive image: everything they would otherwise compute again for
// each new parameter.
#pragma once

#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include <pimg/progressive_image.h>
#include <pimg/regions.h>
#include <pimg/sampling.h>

#include "source/gains/contrast_envelope.h"
#include "source/guide.h"
#include "source/overview.h"
#include "source/smoothing_data.h"
#include "source/wrap/wrap.h"

namespace pimg {
inline namespace PIMG_ABI {

/// Bands of log luminance, whatever the guide was.
struct LogBands {
    LogLuminance luminance;
    const Bands* bands = nullptr;
};

/// Bands of the colour channels as stored. `exponent`: samples were scaled by 2^-exponent so that sums of
/// them stay finite.
struct ChannelBands {
    std::vector<Bands> bands;
    int exponent = 0;
};

/// The details of all colour channels, ready to be swept together.
struct PlannedChannels {
    std::shared_ptr<const SweepPlan> plan;
    std::vector<std::vector<Detail>> ordered;  ///< empty if the plan's order is the hierarchy's
    std::vector<const Detail*> details;        ///< of each channel, in the order of the plan
};

struct ProgressiveImage::Data {
    OIIO::ImageBuf source;    ///< with the margins of `wrap`
    OIIO::ImageSpec spec;     ///< of the picture that was given, with these margins
    OIIO::ImageSpec picture;  ///< of the picture that was given
    Wrap wrap;
    BuildOptions options;
    Colour colour;
    bool whole_numbers = false;  ///< the source stores integers, which are 0..1 here; all scales depend on this
    std::vector<SpecialSample> specials;  ///< by pixel, then channel
    Hierarchy hierarchy;
    std::vector<Bands> guide_bands;
    BuildStats stats;

    /// Of a preview, the reduced log luminance with its hierarchy, and how many pixels across and down are one of its. The
    /// hierarchy here has no splits then.
    std::unique_ptr<Data> small;
    int step = 1;

    /// These fill a cache at the first call. Null, with an error, only if the hierarchy is damaged.
    const LogBands* log_bands(const ParallelFor& parallel, std::string& error);
    const ChannelBands* channel_bands(const ParallelFor& parallel, std::string& error);

    /// The noise of the picture, after log_bands(). Estimated at the first call: only hdr_compress asks for it.
    const NoiseModel& noise(const ParallelFor& parallel);

    /// Says that sweeps will be many: the following then make a sweep plan at the first call.
    void expect_retunes();

    /// The same bands ready for another sweep, after log_bands(). A sweep plan is made at the second call, from which
    /// on it saves time.
    std::shared_ptr<const PlannedBands> planned_log_bands(const ParallelFor& parallel);

    /// Likewise the details of channel_bands().
    std::shared_ptr<const PlannedChannels> planned_channels(const ParallelFor& parallel, std::string& error);

    /// Likewise what smoothing by strength needs of the channels, or, if `log`, of their logarithms.
    std::shared_ptr<const SmoothingData> smoothing(bool log, const ParallelFor& parallel);

    /// See without_texture(); after log_bands(). Kept.
    const std::vector<float>& luminance_without_texture(const ParallelFor& parallel);

    /// What compression and exposure are found from. Kept; null, with an error, like the bands.
    const Overview* overview(const ParallelFor& parallel, std::string& error);

    /// See contrast_envelope(). Kept for what it was last asked for.
    std::shared_ptr<const Envelope> envelope(const std::shared_ptr<const PlannedBands>& planned,
                                             const EnvelopeOptions& how, const ParallelFor& parallel);

    /// How visible the details of every split are beside `times` times the noise, 0 to 1, in the order of the hierarchy;
    /// empty if there is no noise. Kept for what it was last asked for. Null, with an error, like the bands.
    std::shared_ptr<const std::vector<float>> visibility(float times, const ParallelFor& parallel, std::string& error);

    /// A vector that held a raster before, if one is left: new memory would have to be cleared for every new setting.
    std::vector<float> take_scratch();
    void keep_scratch(std::vector<float>&& scratch);

    /// Merges of the picture's pieces, fine enough for a cut into `regions` regions. Kept. Null, with an error, like
    /// the bands.
    std::shared_ptr<const RegionTree> region_tree(std::size_t regions, const ParallelFor& parallel, std::string& error);

    std::size_t memory();

    /// The steps of build() and adopt(). `make_hierarchy` fills in the hierarchy and the bands of the guide.
    using MakeHierarchy = std::function<Status(const std::vector<Raster>& guide)>;
    bool read(const OIIO::ImageBuf& src, std::string& error);
    bool hierarchy_of_guide(const MakeHierarchy& make_hierarchy, const ParallelFor& parallel, std::string& error);
    Status simplify_guide(const std::vector<Raster>& guide, const ParallelFor& parallel, const Progress& progress);
    Status build_hierarchy(const std::vector<Raster>& guide, const ParallelFor& parallel, const Progress& progress);
    Status adopt(const std::vector<Raster>& guide, const StoredHierarchy& stored);
    bool build_preview(const ParallelFor& parallel, const Progress& progress, std::string& error);
    bool find_initial_mesh(const Guide& guide, const ParallelFor& parallel, const Progress& progress, InitialMesh& mesh,
                           std::string& error) const;

private:
    bool are_channels_the_guide() const;
    bool is_to_be_planned(int& sweeps) const { return ++sweeps > 1 || m_expects_retunes || m_plan; }
    std::shared_ptr<const SweepPlan> plan(const ParallelFor& parallel);

    std::mutex m_mutex;
    bool m_expects_retunes = false;
    std::shared_ptr<const SweepPlan> m_plan;
    std::unique_ptr<LogBands> m_log;
    std::optional<NoiseModel> m_noise;
    std::unique_ptr<ChannelBands> m_channels;
    std::shared_ptr<const PlannedChannels> m_planned_channels;
    int m_channel_sweeps = 0;
    std::shared_ptr<SmoothingData> m_smoothing[2];  ///< as stored, logarithms
    int m_smoothing_sweeps[2] = { 0, 0 };
    float m_guide_scale = 0.0f;  ///< see StoredGuide; of luma and rgb guides
    bool m_guide_clipped = false;
    Bands m_log_bands;  ///< if they are not the guide's
    std::shared_ptr<const PlannedBands> m_planned_log;
    int m_log_sweeps = 0;
    std::vector<float> m_without_texture;
    float m_visible_beside = -1.0f;  ///< times the noise
    std::shared_ptr<const std::vector<float>> m_visibility;
    std::unique_ptr<Overview> m_overview;
    std::shared_ptr<const PlannedBands> m_envelope_bands;
    EnvelopeOptions m_envelope_options;
    std::shared_ptr<const Envelope> m_envelope;
    std::shared_ptr<const RegionTree> m_regions;
    std::mutex m_scratch_mutex;  ///< held for moments only
    std::vector<std::vector<float>> m_scratch;
};

/// Samples of one channel of the source, row-major.
std::vector<float> channel_samples(const ProgressiveImage::Data& data, int channel);

/// `size` floats without particular values. Afterwards the image keeps the memory for the next Scratch.
class Scratch {
public:
    Scratch(ProgressiveImage::Data& data, std::size_t size) : m_data(data), m_values(data.take_scratch())
    {
        m_values.resize(size);
    }
    Scratch(const Scratch&) = delete;
    Scratch& operator=(const Scratch&) = delete;
    ~Scratch() { m_data.keep_scratch(std::move(m_values)); }

    std::vector<float>& operator*() { return m_values; }
    const std::vector<float>& operator*() const { return m_values; }

private:
    ProgressiveImage::Data& m_data;
    std::vector<float> m_values;
};

}  // namespace PIMG_ABI
}  // namespace pimg
