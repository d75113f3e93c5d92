// SPDX-License-Identifier: BSD-3-Clause
#include "session/stats.h"

#include <sys/resource.h>

#include <OpenImageIO/strutil.h>

#include <pimg/detail/format.h>

namespace pimgtool {

namespace {

using pimg::format;
using pimg::quoted_json;

int thread_count()
{
    int threads = 0;
    OIIO::getattribute("threads", threads);
    return threads;
}

}  // namespace

std::size_t peak_memory()
{
    rusage usage {};
    getrusage(RUSAGE_SELF, &usage);
#ifdef __APPLE__
    return std::size_t(usage.ru_maxrss);
#else
    return std::size_t(usage.ru_maxrss) * 1024;
#endif
}

void Stats::add(const std::string& name, const pimg::ProgressiveImage& image)
{
    add(Stage::read, image.stats().read_seconds);
    add(Stage::luminance, image.stats().guide_seconds);
    add(Stage::build, image.stats().sample_seconds + image.stats().simplify_seconds);

    const pimg::Hierarchy& hierarchy = image.hierarchy();
    const OIIO::ImageSpec& spec = image.spec();
    HierarchyFigures figures;
    figures.name = name;
    figures.width = spec.width;
    figures.height = spec.height;
    figures.channels = spec.nchannels;
    figures.type = spec.format.c_str();
    figures.guide = image.stats().guide;
    figures.vertices = hierarchy.vertices();
    figures.splits = hierarchy.levels();
    // A split adds two faces or, on the border, one.
    figures.faces = hierarchy.base_triangles.size();
    for (const pimg::Split& split : hierarchy.splits)
        figures.faces += split.vl == pimg::kGhost || split.vr == pimg::kGhost ? 1 : 2;
    figures.base_vertices = hierarchy.base_vertices();
    figures.base_faces = hierarchy.base_triangles.size();
    figures.bytes = hierarchy.memory();
    m_hierarchies.push_back(figures);
}

void Stats::add(const Stats& frame)
{
    for (std::size_t i = 0; i < m_seconds.size(); ++i)
        m_seconds[i] += frame.m_seconds[i];
    m_hierarchies.insert(m_hierarchies.end(), frame.m_hierarchies.begin(), frame.m_hierarchies.end());
}

std::string Stats::text() const
{
    std::string out;
    for (const HierarchyFigures& h : m_hierarchies) {
        out += format("{}: {} x {}, {} channel{}, {}\n", h.name, h.width, h.height, h.channels,
                      h.channels == 1 ? "" : "s", h.type);
        out += format("  hierarchy of {}: {} vertices, {} splits, {} faces; base {} vertices, {} faces; {:.1f} MB\n",
                      h.guide, h.vertices, h.splits, h.faces, h.base_vertices, h.base_faces, double(h.bytes) / 1e6);
    }
    out += "seconds:";
    for (std::size_t i = 0; i < kStageNames.size(); ++i)
        out += format(" {} {:.3f},", kStageNames[i], m_seconds[i]);
    out += format(" total {:.3f}\n", total());
    out += format("threads: {}\npeak memory: {:.1f} MB\n", thread_count(), double(peak_memory()) / 1e6);
    return out;
}

std::string Stats::json() const
{
    std::string out = "{\n  \"hierarchies\": [";
    for (const HierarchyFigures& h : m_hierarchies) {
        out += &h == &m_hierarchies.front() ? "\n" : ",\n";
        out += format("    {{ \"name\": {}, \"width\": {}, \"height\": {}, \"channels\": {}, \"type\": \"{}\", "
                      "\"guide\": \"{}\",\n",
                      quoted_json(h.name), h.width, h.height, h.channels, h.type, h.guide);
        out += format("      \"vertices\": {}, \"splits\": {}, \"faces\": {}, \"base_vertices\": {}, "
                      "\"base_faces\": {}, \"bytes\": {} }}",
                      h.vertices, h.splits, h.faces, h.base_vertices, h.base_faces, h.bytes);
    }
    out += m_hierarchies.empty() ? "],\n" : "\n  ],\n";
    out += "  \"seconds\": {";
    for (std::size_t i = 0; i < kStageNames.size(); ++i)
        out += format(" \"{}\": {:.6f},", kStageNames[i], m_seconds[i]);
    out += format(" \"total\": {:.6f} }},\n", total());
    out += format("  \"threads\": {},\n  \"peak_memory_bytes\": {}\n}}\n", thread_count(), peak_memory());
    return out;
}

}  // namespace pimgtool
