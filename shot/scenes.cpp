// SPDX-License-Identifier: BSD-3-Clause
#include "scenes.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace pimg {

namespace {

// Chosen so that in tests/tools/sequence_test.py a pan with noise and drift has no events, and the events that the test
// puts in are all found.
constexpr double kEvent = 0.5;         ///< stops that a cut, a flash or a fade changes at least
constexpr double kOverSpread = 4.0;    ///< and how many times the median deviation around it
constexpr double kFadeStep = 0.01;     ///< stops from frame to frame in a fade to or from black, at least
constexpr double kBlackStops = 10.0;   ///< frames so far below the median frame are black with noise
constexpr double kOpenFade = 2.0;      ///< stops that a fade changes if no black frame is known at its end
constexpr double kOpenFadeStep = 0.1;  ///< and from frame to frame
constexpr std::size_t kNear = 5;       ///< frames on a side that a cut is judged by
constexpr std::size_t kFewest = 3;     ///< on a side: fewer frames may be a flash

double median(std::vector<double> values)
{
    const auto middle = values.begin() + std::ptrdiff_t(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

double spread(std::vector<double> values, double centre)
{
    for (double& v : values)
        v = std::fabs(v - centre);
    return median(std::move(values));
}

class Finder {
public:
    explicit Finder(const std::vector<FrameFigures>& frames) : m_frames(frames), m_roles(frames.size())
    {
        std::vector<double> light;
        for (const FrameFigures& f : frames)
            if (!f.stops.empty())
                light.push_back(f.stops[0]);
        const double usual = light.empty() ? 0.0 : median(light);
        for (std::size_t i = 0; i < frames.size(); ++i)
            m_roles[i].steady = !frames[i].stops.empty() && frames[i].stops[0] > usual - kBlackStops;
        m_lit.reserve(frames.size());
        for (const FrameRole& role : m_roles)
            m_lit.push_back(role.steady);
    }

    void find_fades()
    {
        const int count = int(m_frames.size());
        for (int i = -1; i <= count; ++i)
            if (i < 0 || i == count || !m_lit[std::size_t(i)]) {
                mark_fade(i, -1);
                mark_fade(i, 1);
            }
    }

    void find_cuts(const std::vector<int>& told, bool finds)
    {
        int scene = 0;
        const std::vector<std::size_t> steady = steady_frames();
        std::vector<int> first = told;
        for (std::size_t k = kFewest; finds && k + kFewest <= steady.size(); ++k)
            if (is_cut(steady, k))
                first.push_back(first_frame_after(steady[k - 1], steady[k]));
        std::sort(first.begin(), first.end());
        first.erase(std::unique(first.begin(), first.end()), first.end());
        auto next = first.begin();
        for (std::size_t i = 0; i < m_frames.size(); ++i) {
            for (; next != first.end() && *next <= m_frames[i].frame; ++next)
                scene += i > 0;
            m_roles[i].scene = scene;
        }
    }

    void find_flashes()
    {
        const std::vector<std::size_t> steady = steady_frames();
        std::vector<std::size_t> flashes;
        for (std::size_t k = 0; k < steady.size(); ++k) {
            const std::size_t first = k > kNear ? k - kNear : 0, last = std::min(k + kNear + 1, steady.size());
            std::vector<double> light;
            for (std::size_t j = first; j < last; ++j)
                if (m_roles[steady[j]].scene == m_roles[steady[k]].scene)
                    light.push_back(stops(steady[j], 0));
            const double centre = median(light), off = std::fabs(stops(steady[k], 0) - centre);
            if (light.size() >= kFewest && off > kEvent + kOverSpread * spread(light, centre))
                flashes.push_back(steady[k]);
        }
        for (const std::size_t i : flashes)
            m_roles[i].steady = false;
    }

    std::vector<FrameRole> roles() const { return m_roles; }

private:
    double stops(std::size_t frame, std::size_t figure) const { return m_frames[frame].stops[figure]; }

    /// Marks the frames of a fade: they become brighter from a black frame, or from the first or last known frame, on.
    void mark_fade(int black, int step)
    {
        const int count = int(m_frames.size());
        const auto lit = [&](int i) {
            return i >= 0 && i < count && m_lit[std::size_t(i)];
        };
        int last = black + step;
        while (lit(last) && lit(last + step)
               && stops(std::size_t(last + step), 0) > stops(std::size_t(last), 0) + kFadeStep)
            last += step;
        if (!lit(black + step) || last == black + step)
            return;
        const double change = stops(std::size_t(last), 0) - stops(std::size_t(black + step), 0);
        const bool open = black < 0 || black == count;
        if (change < (open ? kOpenFade : kEvent) || (open && change < kOpenFadeStep * std::abs(last - black - step)))
            return;
        for (int i = black + step; i != last; i += step)  // the brightest frame belongs to the scene
            m_roles[std::size_t(i)].steady = false;
    }

    std::vector<std::size_t> steady_frames() const
    {
        std::vector<std::size_t> steady;
        for (std::size_t i = 0; i < m_roles.size(); ++i)
            if (m_roles[i].steady)
                steady.push_back(i);
        return steady;
    }

    /// Whether a scene begins at the k-th of the steady frames.
    bool is_cut(const std::vector<std::size_t>& steady, std::size_t k) const
    {
        for (std::size_t figure = 0; figure < m_frames[steady[k]].stops.size(); ++figure) {
            std::vector<double> before, after;
            for (std::size_t j = k - std::min(k, kNear); j < std::min(k + kNear, steady.size()); ++j)
                (j < k ? before : after).push_back(stops(steady[j], figure));
            const double b = median(before), a = median(after), change = std::fabs(a - b);
            const double jump = std::fabs(stops(steady[k], figure) - stops(steady[k - 1], figure));
            if (change > kEvent + kOverSpread * std::max(spread(before, b), spread(after, a)) && jump > 0.5 * change)
                return true;
        }
        return false;
    }

    /// The first frame of a scene whose cut comes after the steady frame `before`: a fade in belongs to the scene, a
    /// fade out does not.
    int first_frame_after(std::size_t before, std::size_t begin) const
    {
        for (std::size_t i = before + 1; i < begin; ++i)
            if (!m_lit[i])
                return m_frames[i].frame;
        return m_frames[begin].frame;
    }

    const std::vector<FrameFigures>& m_frames;
    std::vector<FrameRole> m_roles;
    std::vector<char> m_lit;
};

}  // namespace

std::vector<FrameRole> find_scenes(const std::vector<FrameFigures>& frames, const std::vector<int>& told,
                                   bool finds_cuts)
{
    Finder finder(frames);
    finder.find_fades();
    finder.find_cuts(told, finds_cuts);
    finder.find_flashes();
    return finder.roles();
}

}  // namespace pimg
