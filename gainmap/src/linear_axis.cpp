// SPDX-License-Identifier: BSD-3-Clause
#include "linear_axis.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace pimg {
inline namespace PIMG_ABI {

namespace {

/// Keeps the equations solvable where no pixel of the large picture depends on a value of the small one.
constexpr double kTiny = 1e-9;

}  // namespace

LinearAxis LinearAxis::between(int fine, int coarse)
{
    LinearAxis axis;
    axis.m_diagonal.assign(std::size_t(coarse), kTiny);
    axis.m_above.assign(std::size_t(coarse), 0.0);
    for (int x = 0; x < fine; ++x) {
        const double at = std::clamp((x + 0.5) * coarse / fine - 0.5, 0.0, double(coarse - 1));
        const int first = std::min(int(at), std::max(coarse - 2, 0));
        const Place place { first, std::min(first + 1, coarse - 1), at - first };
        axis.m_places.push_back(place);
        axis.m_diagonal[std::size_t(place.first)] += (1.0 - place.share) * (1.0 - place.share);
        axis.m_diagonal[std::size_t(place.second)] += place.share * place.share;
        axis.m_above[std::size_t(place.first)] += (1.0 - place.share) * place.share;
    }
    axis.m_ratio.assign(std::size_t(coarse), 0.0);
    for (std::size_t i = 1; i < axis.m_diagonal.size(); ++i) {
        axis.m_ratio[i] = axis.m_above[i - 1] / axis.m_diagonal[i - 1];
        axis.m_diagonal[i] -= axis.m_ratio[i] * axis.m_above[i - 1];
    }
    return axis;
}

void LinearAxis::fit(const double* values, std::size_t stride, double* result, std::size_t result_stride) const
{
    const std::size_t count = m_diagonal.size();
    std::vector<double> sums(count, 0.0), least(count, std::numeric_limits<double>::infinity());
    std::vector<double> most(count, -std::numeric_limits<double>::infinity());
    for (std::size_t x = 0; x < m_places.size(); ++x) {
        const Place& place = m_places[x];
        const double value = values[x * stride];
        const auto add = [&](int i, double weight) {
            const std::size_t at = std::size_t(i);
            sums[at] += weight * value;
            if (weight > 0.0) {
                least[at] = std::min(least[at], value);
                most[at] = std::max(most[at], value);
            }
        };
        add(place.first, 1.0 - place.share);
        add(place.second, place.share);
    }
    for (std::size_t i = 1; i < count; ++i)
        sums[i] -= m_ratio[i] * sums[i - 1];
    for (std::size_t i = count; i-- > 0;) {
        const double above = i + 1 < count ? m_above[i] * sums[i + 1] : 0.0;
        sums[i] = (sums[i] - above) / m_diagonal[i];
    }
    for (std::size_t i = 0; i < count; ++i)
        result[i * result_stride] = least[i] <= most[i] ? std::clamp(sums[i], least[i], most[i]) : 0.0;
}

}  // namespace PIMG_ABI
}  // namespace pimg
