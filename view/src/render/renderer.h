// SPDX-License-Identifier: BSD-3-Clause
// The picture a filter stack makes of a document, at one of its sizes.
#pragma once

#include <atomic>
#include <memory>
#include <string>
#include <vector>

#include "render/document.h"
#include "state/filter_stack.h"

namespace pimgview {

/// A result.
struct Rendering {
    std::shared_ptr<const OIIO::ImageBuf> pixels;  ///< null after an error
    int factor = 1;                                ///< of the rung it was made from
    bool linear_light = false;  ///< its numbers are linear light, to be encoded for files of whole numbers
    bool labels = false;        ///< its numbers are those of regions
    std::string layer;          ///< the picture among its channels; see BuildOptions
    double seconds = 0.0;       ///< spent in filters and in building what later filters need
    std::string error;          ///< one line that begins with the filter's command; "stopped" when asked to stop
};

/// Remembers what came out of each filter of the last stack, so that only what follows a change is done again. For one
/// thread at a time.
class Renderer {
public:
    /// `writes`: options that name a file to be written, such as strokes, have their effect.
    explicit Renderer(bool writes = false) : m_writes(writes) { }

    /// The result of the filters that are on. The rung must have an image unless none is on.
    Rendering render(const DocumentState& document, const Rung& rung, const FilterStack& stack,
                     const std::atomic<bool>& stop);

    /// Bytes of what is remembered.
    std::size_t memory() const;

private:
    /// What came out of one filter, and the progressive image of it when the next has asked for it.
    struct Stage {
        std::string argument;
        Rendering result;
        std::shared_ptr<const pimg::ProgressiveImage> image;
    };

    bool is_too_much(const DocumentState& document, const OIIO::ImageBuf& next) const;
    bool apply(const StackItem& item, Stage& stage, const Rendering& before, const pimg::ProgressiveImage& image,
               const std::atomic<bool>& stop);

    const bool m_writes;
    std::vector<Stage> m_stages;
    std::shared_ptr<const OIIO::ImageBuf> m_source;
    int m_version = -1;
};

/// Of the rungs that are built, the coarsest whose pixels are at most `scale` pixels of the file wide; if there is none
/// such, the finest that is built. Null if none is built.
const Rung* built_rung(const DocumentState& document, double scale);

/// Writes what the stack makes of the document, which must be built, as pimgtool would: its formats, types and colour
/// rules; a .pimg file has the hierarchy. Names that end in .svg or .json are for the strokes of the last filter that has
/// some. Files are written whole or not at all.
bool save(const DocumentState& document, const FilterStack& stack, const std::string& filename,
          const std::atomic<bool>& stop, std::string& summary, std::string& error);

}  // namespace pimgview
