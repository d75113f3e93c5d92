// SPDX-License-Identifier: BSD-3-Clause
#include "ops/zone_curve.h"

#include <algorithm>
#include <cmath>

#include <pimg/detail/format.h>

#include "base/curve_text.h"

namespace pimg {
inline namespace PIMG_ABI {

namespace {

constexpr int kStepsPerStop = 32;     ///< of the table, which is linear in between
constexpr double kFarthest = 64.0;    ///< stops above or below middle grey
constexpr double kMostRaised = 16.0;  ///< stops
constexpr int kZone = 3;              ///< stops from middle grey to where shadows and highlights are all that is raised

/// From one zone to the next the curve runs smoothly: 3 x^2 - 2 x^3, whose steepest slope is half as much again as that of
/// a line.
std::vector<CurvePoint> points_of_zones(double shadows, double midtones, double highlights)
{
    std::vector<CurvePoint> points;
    for (int i = -kZone * kStepsPerStop; i <= kZone * kStepsPerStop; ++i) {
        const double x = std::fabs(double(i)) / (kZone * kStepsPerStop);
        const double share = x * x * (3.0 - 2.0 * x);
        points.push_back({ double(i) / kStepsPerStop, midtones + share * ((i < 0 ? shadows : highlights) - midtones) });
    }
    return points;
}

bool is_curve(const std::vector<CurvePoint>& points)
{
    for (std::size_t i = 0; i < points.size(); ++i)
        if (std::fabs(points[i].position) > kFarthest || std::fabs(points[i].value) > kMostRaised
            || (i > 0 && points[i].position <= points[i - 1].position))
            return false;
    return !points.empty();
}

double linear_at(const std::vector<CurvePoint>& points, double position)
{
    const auto next =
        std::find_if(points.begin(), points.end(), [&](const CurvePoint& point) { return point.position > position; });
    if (next == points.begin() || next == points.end())
        return next == points.begin() ? points.front().value : points.back().value;
    const CurvePoint& a = *(next - 1);
    return a.value + (position - a.position) / (next->position - a.position) * (next->value - a.value);
}

}  // namespace

bool ZoneCurve::make(const HdrCompressOptions& options, ZoneCurve& curve, std::string& error)
{
    curve = {};
    const bool has_words = options.shadows != 0.0f || options.midtones != 0.0f || options.highlights != 0.0f;
    std::vector<CurvePoint> points;
    if (options.zones.empty()) {
        if (!has_words)
            return true;
        points = points_of_zones(double(options.shadows), double(options.midtones), double(options.highlights));
    } else if (has_words) {
        error = "zones: expected without shadows, midtones and highlights";
        return false;
    } else if (!parse_curve(options.zones, points) || !is_curve(points)) {
        error =
            format("zones=\"{}\": expected stops:raised,... with stops that rise from at least -{} to at most {}, and "
                   "at most {} stops up or down",
                   options.zones, kFarthest, kFarthest, kMostRaised);
        return false;
    }
    const double first = points.front().position;
    const int steps = int(std::ceil((points.back().position - first) * kStepsPerStop)) + 1;
    curve.m_first = float(first);
    for (int i = 0; i <= steps; ++i)
        curve.m_raised.push_back(float(linear_at(points, first + double(i) / kStepsPerStop)));
    return true;
}

float ZoneCurve::at(float stops) const
{
    const float step = std::clamp((stops - m_first) * float(kStepsPerStop), 0.0f, float(m_raised.size() - 2));
    const auto i = std::size_t(step);
    return m_raised[i] + (step - float(i)) * (m_raised[i + 1] - m_raised[i]);
}

}  // namespace PIMG_ABI
}  // namespace pimg
