// SPDX-License-Identifier: BSD-3-Clause
// What a progressive image keeps for those who sweep its bands again and again.
#include <memory>
#include <utility>

#include <pimg/detail/retuning.h>
#include <pimg/detail/smoothing_plan.h>
#include <pimg/detail/stop.h>

#include "source/progressive_image_data.h"

namespace pimg {
inline namespace PIMG_ABI {

void expect_retunes(const ProgressiveImage& image)
{
    image.data()->expect_retunes();
}

void ProgressiveImage::Data::expect_retunes()
{
    const std::lock_guard<std::mutex> lock(m_mutex);
    m_expects_retunes = true;
}

/// To be called with the lock.
std::shared_ptr<const SweepPlan> ProgressiveImage::Data::plan(const ParallelFor& parallel)
{
    if (m_plan == nullptr)
        m_plan = std::make_shared<const SweepPlan>(hierarchy, parallel);
    return m_plan;
}

std::shared_ptr<const PlannedBands> ProgressiveImage::Data::planned_log_bands(const ParallelFor& parallel)
{
    const std::unique_lock<std::mutex> lock = lock_or_stop(m_mutex);
    const bool planned = is_to_be_planned(m_log_sweeps);
    if (m_planned_log == nullptr || (planned && m_planned_log->shared != m_plan)) {
        const auto made = planned ? plan(parallel) : std::make_shared<const SweepPlan>(SweepPlan::unplanned(hierarchy));
        m_planned_log = std::make_shared<const PlannedBands>(made, *m_log->bands, parallel);
    }
    return m_planned_log;
}

std::shared_ptr<const std::vector<float>> ProgressiveImage::Data::visibility(float times, const ParallelFor& parallel,
                                                                             std::string& error)
{
    const LogBands* log = log_bands(parallel, error);
    if (log == nullptr)
        return nullptr;
    EnvelopeOptions how;
    how.noise = noise(parallel).times(times);
    const std::unique_lock<std::mutex> lock = lock_or_stop(m_mutex);
    if (m_visibility == nullptr || m_visible_beside != times) {
        const auto in_order = std::make_shared<const SweepPlan>(SweepPlan::unplanned(hierarchy));
        Envelope envelope = contrast_envelope(PlannedBands(in_order, *log->bands, parallel), how, parallel);
        m_visibility = std::make_shared<const std::vector<float>>(std::move(envelope.visibility));
        m_visible_beside = times;
    }
    return m_visibility;
}

std::shared_ptr<const PlannedChannels> ProgressiveImage::Data::planned_channels(const ParallelFor& parallel,
                                                                                std::string& error)
{
    const ChannelBands* channels = channel_bands(parallel, error);
    if (channels == nullptr)
        return nullptr;
    const std::unique_lock<std::mutex> lock = lock_or_stop(m_mutex);
    const bool planned = is_to_be_planned(m_channel_sweeps);
    if (m_planned_channels != nullptr && (!planned || m_planned_channels->plan == m_plan))
        return m_planned_channels;
    auto made = std::make_shared<PlannedChannels>();
    made->plan = planned ? plan(parallel) : std::make_shared<const SweepPlan>(SweepPlan::unplanned(hierarchy));
    for (const Bands& bands : channels->bands) {
        if (made->plan->is_planned())
            made->ordered.push_back(made->plan->in_order(bands.details, parallel));
        made->details.push_back(made->plan->is_planned() ? made->ordered.back().data() : bands.details.data());
    }
    m_planned_channels = std::move(made);
    return m_planned_channels;
}

std::shared_ptr<const SmoothingData> ProgressiveImage::Data::smoothing(bool log, const ParallelFor& parallel)
{
    const std::unique_lock<std::mutex> lock = lock_or_stop(m_mutex);
    std::shared_ptr<SmoothingData>& cached = m_smoothing[log ? 1 : 0];
    const bool planned = is_to_be_planned(m_smoothing_sweeps[log ? 1 : 0]);
    if (cached == nullptr)
        cached = std::make_shared<SmoothingData>(prepare_smoothing(*this, log));
    if (planned && cached->source.plan == nullptr) {
        // Who has it already goes on in the old order.
        const auto reordered = std::make_shared<SmoothingData>(*cached);
        plan_sweeps(plan(parallel), reordered->source, parallel);
        cached = reordered;
    }
    return cached;
}

}  // namespace PIMG_ABI
}  // namespace pimg
