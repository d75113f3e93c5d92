// SPDX-License-Identifier: BSD-3-Clause
#include "render.h"

#include <cmath>

#include <pimg/detail/format.h>
#include <pimg/detail/retuning.h>
#include <pimg/detail/stop.h>
#include <pimg/display.h>
#include <pimg/labels.h>

#include "colour_space.h"

namespace pimg_ofx {

namespace {

std::string joined(const pimg::OptionTexts& texts)
{
    std::string line;
    for (const auto& [key, value] : texts)
        line.append("\n").append(key).append("=").append(value);
    return line;
}

/// What the host asks for.
struct Request {
    OfxTime time = 0.0;
    double scale = 1.0;  ///< that of proxies
    Placement placement;
};

Request request_of(const Properties& in)
{
    Request request;
    request.time = in.real(kOfxPropTime);
    // Lengths follow the area where a proxy is not reduced equally in both directions.
    const double across = in.real(kOfxImageEffectPropRenderScale, 0, 1.0),
                 down = in.real(kOfxImageEffectPropRenderScale, 1, across);
    const double scale = across == down ? across : std::sqrt(across * down);
    request.scale = scale > 0.0 && std::isfinite(scale) ? scale : 1.0;
    request.placement.window = in.rect(kOfxImageEffectPropRenderWindow);
    return request;
}

/// Of fielded material only the lines of one field are written, if the image has room for both.
void choose_rows(const Properties& in, const Image& output, Placement& placement)
{
    const std::string field = in.text(kOfxImageEffectPropFieldToRender, 0, kOfxImageFieldNone);
    if (!output.holds_both_fields() || (field != kOfxImageFieldLower && field != kOfxImageFieldUpper))
        return;
    placement.row_step = 2;
    placement.first_row = field == kOfxImageFieldUpper ? 1 : 0;
}

/// The whole result of a filter.
class KeptResult : public Kept {
public:
    std::size_t memory() const override { return pixels.spec().image_bytes(); }
    OIIO::ImageBuf pixels;
};

/// `depth` is that of the output.
std::shared_ptr<const KeptResult> run(const pimg::BoundFilter& filter, const pimg::ProgressiveImage& image,
                                      const OIIO::TypeDesc& depth, int threads, std::string& error)
{
    auto result = std::make_shared<KeptResult>();
    const OIIO::ImageSpec& spec = image.spec();
    if (filter.output == pimg::FilterOutput::labels)
        result->pixels.reset(OIIO::ImageSpec(spec.width, spec.height, 1, OIIO::TypeDesc::FLOAT));
    bool fine = filter(result->pixels, image, OIIO::ROI(), threads);
    // Like a file of whole numbers, an image of them is for a display.
    if (fine && filter.output == pimg::FilterOutput::light && !depth.is_floating_point()) {
        result->pixels = pimg::srgb_encoded(result->pixels, threads);
        fine = !result->pixels.has_error();
    }
    if (!fine)
        error = result->pixels.has_error() ? result->pixels.geterror() : "the filter failed";
    const int labels = result->pixels.spec().get_int_attribute(pimg::kLabelCount);
    if (fine && double(labels) - 1.0 > pimg::largest_label(depth)) {
        error = pimg::format("{} labels: expected at most {} in images of that depth", labels,
                             pimg::largest_label(depth) + 1.0);
        fine = false;
    }
    return fine ? result : nullptr;
}

/// One render action.
class Render {
public:
    Render(Instance& instance, const Properties& in, Watch& watch)
        : m_instance(instance),
          m_in(in),
          m_watch(watch),
          m_request(request_of(in))
    {
    }

    /// False with a line in `error`, which says nothing if it was stopped.
    bool operator()(std::string& error)
    {
        const Host& host = m_instance.host();
        const Image output(host, m_instance.output_clip(), m_request.time);
        if (!output) {
            error = "the host gave no output image of a known kind";
            return false;
        }
        OfxRectD region {};
        const bool has_region = m_instance.source_region(m_request.time, region);
        const Image source(host, m_instance.source_clip(), m_request.time, has_region ? &region : nullptr);
        if (!source || is_empty(source.picture())) {
            error = "the clip Source gave no image of a known kind: is it connected?";
            return false;
        }
        pimg::BoundFilter filter;
        const pimg::OptionTexts options = m_instance.options(Owner::filter, m_request.time, m_request.scale);
        if (!m_instance.effect().filter->bind(options, filter, error))
            return false;
        std::string key;
        const std::shared_ptr<const KeptHierarchy> hierarchy =
            hierarchy_of({ m_instance, m_watch, m_request.time }, source, key, error);
        if (hierarchy == nullptr)
            return false;
        const bool done = make(filter, *hierarchy, source, output, key + joined(options), error);
        shared_cache().measure(key);
        return done;
    }

private:
    /// The whole result. It is kept if the host asks for a part, since it will ask for the other parts.
    std::shared_ptr<const KeptResult> result_of(const pimg::BoundFilter& filter, const KeptHierarchy& hierarchy,
                                                const Image& source, const Image& output, const std::string& options,
                                                std::string& error)
    {
        const OfxRectI whole = source.picture(), part = intersection(whole, m_request.placement.window);
        const int threads = m_instance.host().threads();
        const auto make = [&](std::string& why) {
            return run(filter, hierarchy.image, output.depth(), threads, why);
        };
        if (part == whole)
            return make(error);
        const std::string key =
            std::string(m_instance.effect().filter->name) + " " + output.depth().c_str() + " " + options;
        return std::static_pointer_cast<const KeptResult>(shared_cache().get(
            key, make, [&] { return !m_watch.goes_on(); }, error));
    }

    bool make(const pimg::BoundFilter& filter, const KeptHierarchy& hierarchy, const Image& source, const Image& output,
              const std::string& options, std::string& error)
    {
        Placement placement = m_request.placement;
        placement.picture = source.picture();
        placement.is_labels = filter.output == pimg::FilterOutput::labels;
        placement.has_colours = !placement.is_labels && filter.output != pimg::FilterOutput::mask
            && filter.output != pimg::FilterOutput::gain;
        choose_rows(m_in, output, placement);
        const int threads = m_instance.host().threads();
        if (fits(placement, source, output)) {
            OIIO::ImageBuf canvas = canvas_of(output, placement.picture);
            if (filter(canvas, hierarchy.image, OIIO::ROI(), threads))
                return true;
            error = canvas.geterror();
            return false;
        }
        const std::shared_ptr<const KeptResult> result = result_of(filter, hierarchy, source, output, options, error);
        if (result != nullptr)
            write_result(result->pixels, source, placement, output, threads);
        return result != nullptr;
    }

    /// Whether the filter can write to the host's own memory, which saves a copy.
    static bool fits(const Placement& placement, const Image& source, const Image& output)
    {
        const OfxRectI& whole = placement.picture;
        return placement.has_colours && placement.row_step == 1 && placement.window == whole
            && intersection(whole, output.bounds()) == whole && source.depth() == OIIO::TypeDesc::FLOAT
            && output.depth() == OIIO::TypeDesc::FLOAT && source.channels() == output.channels()
            && !output.is_unpremultiplied();
    }

    Instance& m_instance;
    const Properties& m_in;
    Watch& m_watch;
    const Request m_request;
};

}  // namespace

std::shared_ptr<const KeptHierarchy> hierarchy_of(const Viewer& viewer, const Image& image, std::string& key,
                                                  std::string& error)
{
    const Instance& instance = viewer.instance;
    std::string space;
    pimg::BuildOptions options;
    const pimg::OptionTexts texts = instance.options(Owner::build, viewer.time);
    if (!source_space(instance, viewer.time, image.depth(), space, error) || !pimg::set_options(options, texts, error))
        return nullptr;
    options.incolorspace = space;
    const int threads = instance.host().threads();
    const OfxRectI box = image.picture();
    key = pimg::format("{:016x} {}x{}x{} {}{} {} {}{}", fingerprint(image, threads), box.x2 - box.x1, box.y2 - box.y1,
                       image.channels(), image.depth().c_str(), image.is_unpremultiplied() ? " straight" : "", space,
                       host_config(instance), joined(texts));
    const auto make = [&](std::string& why) -> std::shared_ptr<const Kept> {
        auto kept = std::make_shared<KeptHierarchy>();
        const auto progress = [&](float done) {
            return viewer.watch.goes_on(double(done));
        };
        if (kept->image.build(picture_of(image, threads), options, threads, progress)) {
            pimg::expect_retunes(kept->image);
            return kept;
        }
        why = kept->image.error();
        return nullptr;
    };
    return std::static_pointer_cast<const KeptHierarchy>(shared_cache().get(
        key, make, [&] { return !viewer.watch.goes_on(); }, error));
}

OfxStatus render(Instance& instance, const Properties& in)
{
    Watch watch(instance, "Building the hierarchy");
    std::string error;
    try {
        const pimg::StopScope scope([&] { return watch.goes_on(); });
        if (Render(instance, in, watch)(error)) {
            instance.be_content();
            return kOfxStatOK;
        }
    } catch (const pimg::Stopped&) {
    }
    if (watch.stopped())
        return kOfxStatOK;  // the host wanted to stop, and ignores the image
    instance.complain(error);
    return kOfxStatFailed;
}

}  // namespace pimg_ofx
