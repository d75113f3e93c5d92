// SPDX-License-Identifier: BSD-3-Clause
// What --stats reports: sizes of the hierarchies, seconds per stage, peak memory.
#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <string>
#include <vector>

#include <pimg/progressive_image.h>

namespace pimgtool {

/// Where the time goes: reading files (and copying them as float), luminance and log, building hierarchies,
/// filters and colour operations, encoding and writing files.
enum class Stage { read, luminance, build, filter, write };
constexpr std::array<const char*, 5> kStageNames = { "read", "luminance", "build", "filter", "write" };

/// Sizes of one hierarchy that was built.
struct HierarchyFigures {
    std::string name;  ///< of the picture
    int width = 0, height = 0, channels = 0;
    std::string type, guide;
    std::size_t vertices = 0, splits = 0, faces = 0, base_vertices = 0, base_faces = 0, bytes = 0;
};

class Stats {
public:
    void add(Stage stage, double seconds) { m_seconds[std::size_t(stage)] += seconds; }
    void add(const std::string& name, const pimg::ProgressiveImage& image);
    void add(const Stats& frame);

    std::string text() const;
    std::string json() const;

private:
    using Clock = std::chrono::steady_clock;
    double total() const { return std::chrono::duration<double>(Clock::now() - m_start).count(); }

    std::array<double, kStageNames.size()> m_seconds {};
    std::vector<HierarchyFigures> m_hierarchies;
    Clock::time_point m_start = Clock::now();
};

/// Adds the seconds it lived to a stage.
class StageTimer {
public:
    StageTimer(Stats& stats, Stage stage) : m_stats(stats), m_stage(stage) { }
    ~StageTimer() { m_stats.add(m_stage, seconds()); }
    StageTimer(const StageTimer&) = delete;
    StageTimer& operator=(const StageTimer&) = delete;

    double seconds() const { return std::chrono::duration<double>(std::chrono::steady_clock::now() - m_start).count(); }

private:
    Stats& m_stats;
    Stage m_stage;
    std::chrono::steady_clock::time_point m_start = std::chrono::steady_clock::now();
};

/// Largest resident size of this process so far, in bytes.
std::size_t peak_memory();

}  // namespace pimgtool
