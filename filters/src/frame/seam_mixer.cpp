// SPDX-License-Identifier: BSD-3-Clause
#include "frame/seam_mixer.h"

#include <algorithm>

namespace pimg {
inline namespace PIMG_ABI {

namespace {

/// Equal samples stay as they are, infinite ones too.
float mix(float a, float b, float share)
{
    return a == b ? a : a + share * (b - a);
}

}  // namespace

void SeamMixer::mix_rows(const RowSpan& span, float* row) const
{
    const Wrap& wrap = m_data.wrap;
    const int top = m_data.picture.y;
    const std::vector<float> here = mixed_columns(span);
    std::copy(here.begin(), here.end(), row);
    const Fade fade = fade_at(span.y - top, wrap.height, wrap.margin_y);
    if (fade.share == 0.0f)
        return;
    const std::vector<float> there = mixed_columns({ top + fade.other, span.xbegin, span.xend });
    for (std::size_t i = 0; i < here.size(); ++i)
        row[i] = mix(here[i], there[i], fade.share);
}

std::vector<float> SeamMixer::mixed_columns(const RowSpan& span) const
{
    const Wrap& wrap = m_data.wrap;
    const std::size_t channels = std::size_t(m_data.source.nchannels());
    const int left = m_data.spec.x;
    const auto* source = static_cast<const float*>(m_data.source.pixeladdr(left, span.y));
    std::vector<float> all(source, source + std::size_t(wrap.padded_width()) * channels);
    m_filter({ span.y, left, left + wrap.padded_width() }, all.data());
    std::vector<float> result;
    result.reserve(span.width() * channels);
    for (int x = span.xbegin; x < span.xend; ++x) {
        const int at = x - m_data.picture.x;
        const Fade fade = fade_at(at, wrap.width, wrap.margin_x);
        const float* here = &all[std::size_t(at + wrap.margin_x) * channels];
        const float* there = &all[std::size_t((fade.share > 0.0f ? fade.other : at) + wrap.margin_x) * channels];
        for (std::size_t c = 0; c < channels; ++c)
            result.push_back(mix(here[c], there[c], fade.share));
    }
    return result;
}

}  // namespace PIMG_ABI
}  // namespace pimg
