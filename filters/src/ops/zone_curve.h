// SPDX-License-Identifier: BSD-3-Clause
// Zones of exposure: how far what is so many stops above or below middle grey is raised.
#pragma once

#include <string>
#include <vector>

#include <pimg/options.h>

namespace pimg {
inline namespace PIMG_ABI {

/// Stops above middle grey of the scene to stops that such a part of the picture is raised by.
class ZoneCurve {
public:
    /// The curve of the options zones, or shadows, midtones and highlights. Fails, with one line in `error`, for a text
    /// that is no curve, and where both kinds are given.
    static bool make(const HdrCompressOptions& options, ZoneCurve& curve, std::string& error);

    /// Whether nothing is raised.
    bool flat() const { return m_raised.empty(); }

    float at(float stops) const;

private:
    float m_first = 0.0f;         ///< stops above middle grey where the curve begins
    std::vector<float> m_raised;  ///< at even steps from there on
};

}  // namespace PIMG_ABI
}  // namespace pimg
