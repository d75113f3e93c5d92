// SPDX-License-Identifier: BSD-3-Clause
// Results of pictures whose sides meet. Near a seam there are two, one on either side of the padded picture; they are mixed
// so that the share of each falls to nothing where its margin ends.
#pragma once

#include <vector>

#include "frame/image_filter.h"

namespace pimg {
inline namespace PIMG_ABI {

/// Makes spans of the picture. All references must outlive it.
class SeamMixer {
public:
    /// `mixed`: false for results of the picture's middle as they are.
    SeamMixer(const ProgressiveImage::Data& data, const RowFilter& filter, bool mixed)
        : m_data(data),
          m_filter(filter),
          m_mixes(mixed && data.wrap)
    {
    }

    /// Replaces the source's samples in `row` by results. The span is one of the picture, without margins.
    void make(const RowSpan& span, float* row) const
    {
        if (m_mixes)
            mix_rows(span, row);
        else
            m_filter(span, row);
    }

private:
    void mix_rows(const RowSpan& span, float* row) const;
    std::vector<float> mixed_columns(const RowSpan& span) const;

    const ProgressiveImage::Data& m_data;
    const RowFilter& m_filter;
    bool m_mixes;
};

}  // namespace PIMG_ABI
}  // namespace pimg
