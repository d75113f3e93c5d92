// SPDX-License-Identifier: BSD-3-Clause
// The program without its window: what is open, what is to be shown of it, and the newest picture that has been made.
// No function here waits for a picture; threads make them.
#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <mutex>
#include <string>

#include "display/overlay.h"
#include "display/scopes.h"
#include "render/document.h"
#include "render/frame.h"

namespace pimgview {

/// What the window wants to show now.
struct Wanted {
    FilterStack stack;
    Region visible;         ///< part of the picture in view; empty: all of it
    double scale = 1.0;     ///< pixels of the file to a pixel of the screen
    bool dragging = false;  ///< more changes follow: a quick picture counts more than all its pixels
    bool source = false;    ///< the source is shown, too
    pimg::Index mesh = 0;   ///< vertices of the mesh that is drawn; 0: none
    bool pieces = false;    ///< dual pieces are looked up, of that level or of 2000 vertices
    bool scopes = false;    ///< histogram and waveform are shown
    bool playing = false;   ///< the frame before stays until the filters are done with the next
};

/// A picture that has been made.
struct Shown {
    Rendering result, source;
    std::shared_ptr<const Frame> frame, source_frame;  ///< of the same region and size; the second may be null
    Histogram histogram, source_histogram;
    Waveform waveform;
    bool has_scopes = false;
    std::shared_ptr<const MeshLines> mesh;
    std::shared_ptr<const PieceMap> pieces;
    bool filtered = false;      ///< filters have had their effect, if there are any
    bool final = false;         ///< of the finest rung there is
    int document = 0;           ///< version of the document
    int width = 0, height = 0;  ///< of the picture in the file
    int serial = 0;             ///< of the request
    double seconds = 0.0;       ///< from the beginning of the work to this
};

/// What became of saving.
struct SaveState {
    bool busy = false, failed = false;
    std::string text;  ///< "saving a.png ...", "saved a.png: 800 x 600 uint8", or the error
};

class Studio {
public:
    /// `changed` is called from other threads whenever there is something new.
    explicit Studio(std::function<void()> changed);
    ~Studio();

    Document& document() { return m_document; }
    const Document& document() const { return m_document; }

    /// Says what is to be shown. Takes no time if nothing has changed.
    void want(const Wanted& wanted);

    /// The newest picture; null if there is none yet.
    std::shared_ptr<const Shown> shown() const;

    /// One line that says why the newest request gave no picture; empty: it did.
    std::string error() const;

    /// Whether the newest picture is of the present file and all filters, be it a quick one.
    bool has_current() const;

    /// Whether everything that was wanted is shown, at full resolution, and no work is left.
    bool settled() const;

    void save(const FilterStack& stack, const std::string& filename);
    SaveState saving() const;
    void forget_saved();  ///< what was said about the last file; not while one is being saved

    /// Bytes of the document, of what filters remember and of the pictures that are shown, when last counted.
    std::size_t memory() const { return m_document_bytes + m_renderer_bytes[0] + m_renderer_bytes[1]; }

    /// Asks every thread to stop. False if one has not done so after a fifth of a second: reading runs to its end.
    bool stop();

private:
    struct Request {
        Wanted wanted;
        DocumentState document;
        Region region;
        int serial = 0;
    };

    void post(Worker& worker, Renderer& renderer, bool quick, bool at_once);
    void show_source_first(const Request& request);
    void make(const Request& request, Renderer& renderer, bool quick, const std::atomic<bool>& stop);
    void count_memory(const Request& request, const Shown& shown, bool quick);
    void add_source(const Request& request, Shown& shown) const;
    void add_overlays(const Request& request, const Rung& rung, Shown& shown) const;
    void publish(std::shared_ptr<Shown> shown);
    const Rung* quick_rung(const DocumentState& document, double scale) const;
    bool is_served(const Wanted& wanted, const DocumentState& document) const;

    std::function<void()> m_changed;
    std::atomic<std::size_t> m_document_bytes { 0 }, m_renderer_bytes[2] = { { 0 }, { 0 } };
    mutable std::mutex m_mutex;
    std::shared_ptr<const Shown> m_shown;
    std::string m_error;
    int m_error_serial = 0;
    SaveState m_save;
    Request m_request;
    int m_rungs_built = 0;
    std::atomic<double> m_seconds_per_pixel { 0.0 };  ///< that the filters took last; 0: not known
    Document m_document;
    Renderer m_quick_renderer, m_full_renderer;
    Worker m_quick, m_full, m_saver;  ///< last, so that they end before what they work on is destroyed
};

}  // namespace pimgview
