// SPDX-License-Identifier: BSD-3-Clause
// A file being looked at: its pixels, smaller copies of them, and the progressive images of all, built in the
// background.
#pragma once

#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include <OpenImageIO/imagebuf.h>

#include <pimg/option_text.h>
#include <pimg/progressive_image.h>

#include "render/worker.h"
#include "session/input.h"
#include "session/output.h"

namespace pimgview {

/// The picture at one size. A pixel of it is the mean of `factor` x `factor` pixels of the file.
struct Rung {
    int factor = 1;
    std::shared_ptr<const OIIO::ImageBuf> pixels;
    std::shared_ptr<const pimg::ProgressiveImage> image;  ///< null until it is built
    bool glimpse = false;  ///< stands for the smallest until that is built; see glimpse.h
};

/// What there is of a file so far.
struct DocumentState {
    std::string filename;
    std::string part;                 ///< that was asked for; empty: the first that holds a picture
    std::vector<std::string> parts;   ///< names of all parts of the file
    std::vector<std::string> layers;  ///< of the part, those that may be the picture
    int width = 0, height = 0;        ///< of the picture in the file
    std::vector<Rung> rungs;  ///< the file's own size first, then smaller ones; before it has been read, a glimpse
    pimgtool::PixelTypes stored;
    bool linear_light = false;
    pimg::BuildOptions build;
    std::string activity;  ///< "reading", "building 1/4"; empty when nothing is being done
    float progress = 0.0f;
    std::string error;                 ///< one line; empty: fine
    double read_seconds = 0.0;         ///< from open() to the pixels
    double first_build_seconds = 0.0;  ///< and to the first progressive image
    double built_seconds = 0.0;        ///< and to all of them
    int version = 0;                   ///< differs for every file, and every set of options of building

    bool turned = false;  ///< upright, other than in the file

    bool has_picture() const { return !rungs.empty(); }
    bool is_read() const { return has_picture() && !rungs[0].glimpse; }
    bool finished() const { return activity.empty(); }
    std::size_t memory() const;  ///< bytes of pixels and progressive images; waits for filters that fill caches
};

class Document {
public:
    /// `changed` is called from another thread whenever state() says something new.
    explicit Document(std::function<void()> changed);

    /// Forgets the present file and begins with another.
    void open(const std::string& filename, const std::string& part, const pimg::OptionTexts& build);

    /// Builds anew with other options. Those that are wrong become the error.
    void rebuild(const pimg::OptionTexts& build);

    DocumentState state() const;

    /// Asks the running work to stop; it does so when it next looks.
    void cancel() { m_worker.cancel(); }
    bool idle() const { return m_worker.idle(); }

private:
    void begin(const std::string& filename, const std::string& part, const pimg::OptionTexts& build, bool again);
    bool current(int version) const;
    bool read(int version, const std::atomic<bool>& stop);
    void show_read(int version, const pimgtool::InputPart& part, double seconds);
    void show_glimpse(int version, const std::atomic<bool>& stop);
    void build(int version, const std::atomic<bool>& stop);
    bool build_rung(int version, std::size_t rung, const std::atomic<bool>& stop);
    void update(int version, const std::function<void(DocumentState&)>& change);
    void fail(int version, const std::string& error);

    std::function<void()> m_changed;
    mutable std::mutex m_mutex;
    DocumentState m_state;
    Worker m_worker;  ///< last, so that it ends before what it works on is destroyed
};

/// The picture with means of `factor` x `factor` pixels, in its own type, windows and metadata but for their size.
OIIO::ImageBuf reduced(const OIIO::ImageBuf& pixels, int factor);

/// The factors of the smaller copies of a picture: about as large as a window, and about as large as can be built
/// within about a third of a second.
std::vector<int> smaller_factors(int width, int height);

/// Bytes of memory that building a picture takes at most, and those that this program may take of the machine's.
double build_bytes(double pixels);
double most_bytes();

}  // namespace pimgview
