// SPDX-License-Identifier: BSD-3-Clause
// The pictures being worked on. Operations take the picture on top and put their result there; the
// hierarchy of a picture is built when first needed and shared by its copies.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include <OpenImageIO/imagebuf.h>
#include <pimg/progressive_image.h>

#include "session/gain_map_file.h"
#include "session/input.h"
#include "session/output.h"
#include "session/pimg_file.h"
#include "session/stats.h"
#include "shot.h"

namespace pimgtool {

/// A hierarchy to be built, or taken from its file, when first needed.
struct LazyHierarchy {
    pimg::BuildOptions options;
    std::shared_ptr<const StoredHierarchy> stored;  ///< of the file the picture came from, if it has one
    pimg::ProgressiveImage image;
};

/// A picture on the stack. Copies share pixels and hierarchy, neither of which changes any more: an operation makes
/// new ones.
struct Picture {
    std::string name;  ///< of the file it came from
    std::shared_ptr<const OIIO::ImageBuf> pixels;
    std::shared_ptr<LazyHierarchy> hierarchy;
    PixelTypes stored;          ///< pixel types of the file it came from: what it is written as unless told otherwise
    bool linear_light = false;  ///< its numbers are linear light that no colour operation has converted
    bool is_gain = false;       ///< its numbers are logarithms of factors on light
    bool labels = false;        ///< its numbers are those of regions
    Rendition rendition = {};   ///< the same picture for HDR displays, while it is the result of --hdr-compress
    bool is_straight = false;   ///< its reader was asked not to multiply colours by alpha, and no operation has since
    int part = 0;               ///< its number in that file
    std::vector<Picture> others = {};  ///< the other parts of that file: filtered with it if they hold a picture
};

/// What the numbers of a filter's result mean.
enum class Meaning {
    as_before,       ///< the same as those of the picture it was made from
    display_linear,  ///< linear light, white at 1
    gain             ///< logarithms of factors on light, which are kept as float
};

/// The stack, and what the operations on it share. Every function that can fail returns false and leaves a line
/// in error().
class Session {
public:
    using Filter = std::function<bool(OIIO::ImageBuf& dst, const pimg::ProgressiveImage& src)>;
    using PixelOperation = std::function<bool(OIIO::ImageBuf& dst, const OIIO::ImageBuf& src)>;

    /// A file named several times is read and built once: announce() all reads before the first read().
    void announce(const std::string& filename) { ++m_reads_left[filename]; }
    bool read(const std::string& filename);
    /// `options` is for .pimg files.
    bool write(const std::string& filename, const pimg::io::WriteOptions& options);
    /// A JPEG file with a gain map.
    bool write(const std::string& filename, const GainMapRequest& request);
    /// Replaces the top picture, which was read from a file with a gain map, by its HDR rendition.
    bool take_rendition();

    /// Builds the hierarchy of the top picture now, with the given options.
    bool build(const pimg::BuildOptions& options);

    /// Replaces the top picture by the result of a filter on its hierarchy.
    bool filter(const Filter& run, Meaning meaning = Meaning::as_before);

    /// hdr_compress() with the anchors. While a shot is measured, only finds the anchors.
    bool hdr_compress(pimg::HdrCompressOptions options);

    /// Replaces the pixels of the top picture by those an operation without hierarchy makes of them, and likewise those
    /// of the other parts that hold a picture.
    bool change_pixels(const PixelOperation& run);

    /// Runs `work` on the top picture and on the other parts of its file that hold a picture. Nothing changes if it
    /// fails.
    bool for_parts(const std::function<bool(Picture&)>& work);

    bool fail(std::string message);
    const std::string& error() const { return m_error; }

    /// A line for -v.
    void say(const std::string& line) const;

    /// The commands make sure that there is a picture before they ask for it.
    Picture& top() { return stack.back(); }

    std::vector<Picture> stack;
    InputOptions input;    ///< of the files read from here on
    OutputOptions output;  ///< of the files written from here on
    Stats stats;
    bool keeps_renditions = false;  ///< a file with a gain map will be written
    bool verbose = false;

    pimg::Anchors anchors;   ///< of the frame, known from the shot or measured
    bool measuring = false;  ///< only the anchors are to be found
    bool measured = false;

private:
    const pimg::ProgressiveImage* hierarchy_of(const Picture& picture);
    bool filter(Picture& picture, const Filter& run, Meaning meaning);
    bool write(const std::string& filename, const pimg::io::WriteOptions& options,
               const std::function<bool(std::string& bytes, std::string& error)>& finish);
    /// With -v, says what hdr_compress() found.
    bool describe_fit(const pimg::ProgressiveImage& image, pimg::HdrCompressOptions options);
    bool change_pixels(Picture& picture, const PixelOperation& run);
    OutputPicture output_of(const Picture& picture) const;

    std::map<std::string, int> m_reads_left;
    std::map<std::string, Picture> m_kept;  ///< pictures that will be read again, by name and settings
    std::string m_error;
};

}  // namespace pimgtool
