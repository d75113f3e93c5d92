// SPDX-License-Identifier: BSD-3-Clause
// Every filter as an operation of GEGL: pimg:hdr-compress, pimg:paint, pimg:feature-lowpass and so on, with properties
// made from the option tables. GEGL's own macros want properties written out, so classes are registered by hand here.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <mutex>
#include <string>
#include <string_view>
#include <vector>

#include <OpenImageIO/strutil.h>

#include <pimg/detail/format.h>
#include <pimg/filter_table.h>

extern "C" {
#include <gegl-plugin.h>
}

namespace {

using pimg::Filter;
using pimg::OptionInfo;

/// An operation is one object of this class for as long as its node is in the graph. The hierarchy is kept and built
/// again only when other pixels come in.
struct Operation {
    GeglOperationFilter parent;
    struct State* state;
};

/// Guarded by the mutex. It is copied before use, so that nobody holds the lock while the threads of a filter run.
struct State {
    std::mutex mutex;
    pimg::OptionTexts texts;       ///< properties that have been set
    pimg::ProgressiveImage image;  ///< of the pixels that came in last
    std::size_t fingerprint = 0;   ///< of these pixels
    pimg::BuildOptions build;      ///< what it was built with

    pimg::OptionTexts texts_now()
    {
        const std::lock_guard<std::mutex> lock(mutex);
        return texts;
    }
};

struct OperationClass {
    GeglOperationFilterClass parent;
    const Filter* filter;
    std::vector<OptionInfo>* options;  ///< in the order of their ids, which start at 1
};

/// The option of building that pictures without metadata need: sides that meet.
constexpr const char* kWrap = "wrap";

Operation* operation_of(void* object)
{
    return static_cast<Operation*>(object);
}

const OperationClass* class_of(void* object)
{
    return reinterpret_cast<OperationClass*>(static_cast<GTypeInstance*>(object)->g_class);
}

// ---- properties -------------------------------------------------------------------------------------------

/// Names of GEGL have dashes in place of underscores.
std::string dashed(std::string name)
{
    std::replace(name.begin(), name.end(), '_', '-');
    return name;
}

/// A range that a slider can span.
void find_slider(const OptionInfo& option, double preset, double& low, double& high)
{
    low = option.min;
    high = option.min == option.max ? 1.0 : option.max;
    if (high > 1000.0)
        high = std::max({ 1.0, 10.0 * preset, 10.0 * std::max(low, 0.0) });
}

/// For options that need not be set, -1 stands for "not set", as in the options structs; the range includes it.
GParamSpec* property(const OptionInfo& option, GParamFlags more)
{
    const std::string name = dashed(option.key), label = pimg::label_of(option.key),
                      help = pimg::label_of(option.help) + (option.unit.empty() ? "" : " (" + option.unit + ")");
    const auto flags = GParamFlags(G_PARAM_READWRITE | int(more) | GEGL_PARAM_PAD_INPUT);
    const bool unset = option.default_value.empty();
    const double preset = unset ? -1.0 : OIIO::Strutil::stod(option.default_value);
    const double least = unset ? -1.0 : option.min;
    double low = 0.0, high = 1.0;
    find_slider(option, preset, low, high);
    if (option.type == "flag")
        return g_param_spec_boolean(name.c_str(), label.c_str(), help.c_str(), option.default_value == "1", flags);
    if (option.type == "int")
        return gegl_param_spec_int(name.c_str(), label.c_str(), help.c_str(), int(least), int(option.max), int(preset),
                                   int(std::min(low, least)), int(high), 1.0, flags);
    if (option.type == "float")
        return gegl_param_spec_double(name.c_str(), label.c_str(), help.c_str(), least, option.max, preset,
                                      std::min(low, least), high, 1.0, flags);
    const std::string words = option.choices.empty() ? help : help + ": " + option.choices;
    return gegl_param_spec_string(name.c_str(), label.c_str(), words.c_str(), FALSE, TRUE, option.default_value.c_str(),
                                  flags);
}

std::string text_of(const GValue* value)
{
    if (G_VALUE_HOLDS_BOOLEAN(value))
        return g_value_get_boolean(value) ? "1" : "0";
    if (G_VALUE_HOLDS_INT(value))
        return std::to_string(g_value_get_int(value));
    if (G_VALUE_HOLDS_DOUBLE(value))
        return pimg::format("{}", g_value_get_double(value));
    const char* text = g_value_get_string(value);
    return text != nullptr ? text : "";
}

void set_property(GObject* object, guint id, const GValue* value, GParamSpec* spec)
{
    State& state = *operation_of(object)->state;
    const std::string& key = (*class_of(object)->options)[id - 1].key;
    const std::lock_guard<std::mutex> lock(state.mutex);
    const auto given =
        std::find_if(state.texts.begin(), state.texts.end(), [&](auto& text) { return text.first == key; });
    if (given != state.texts.end())
        state.texts.erase(given);
    if (!g_param_value_defaults(spec, value))
        state.texts.emplace_back(key, text_of(value));
}

void get_property(GObject* object, guint id, GValue* value, GParamSpec* spec)
{
    State& state = *operation_of(object)->state;
    const std::string& key = (*class_of(object)->options)[id - 1].key;
    const std::lock_guard<std::mutex> lock(state.mutex);
    g_param_value_set_default(spec, value);
    for (const auto& [name, text] : state.texts) {
        if (name != key)
            continue;
        if (G_VALUE_HOLDS_BOOLEAN(value))
            g_value_set_boolean(value, text == "1");
        else if (G_VALUE_HOLDS_INT(value))
            g_value_set_int(value, OIIO::Strutil::stoi(text));
        else if (G_VALUE_HOLDS_DOUBLE(value))
            g_value_set_double(value, OIIO::Strutil::stod(text));
        else
            g_value_set_string(value, text.c_str());
    }
}

gpointer parent_class = nullptr;

// ---- pixels -----------------------------------------------------------------------------------------------

/// Linear light with associated alpha, in the primaries of the input: what OpenImageIO and pimg mean by RGBA.
const Babl* pixel_format(GeglOperation* operation)
{
    return babl_format_with_space("RaGaBaA float", gegl_operation_get_source_space(operation, "input"));
}

void prepare(GeglOperation* operation)
{
    gegl_operation_set_format(operation, "input", pixel_format(operation));
    gegl_operation_set_format(operation, "output", pixel_format(operation));
}

GeglRectangle whole_input(GeglOperation* operation)
{
    const GeglRectangle* box = gegl_operation_source_get_bounding_box(operation, "input");
    return box != nullptr ? *box : GeglRectangle { 0, 0, 0, 0 };
}

/// Whether there is a picture of some size: patterns such as gegl:checkerboard have no end, and some inputs are empty.
bool is_picture(const GeglRectangle& box)
{
    return box.width > 0 && box.height > 0 && !gegl_rectangle_is_infinite_plane(&box);
}

/// The region of the input that is needed: all of it, because the hierarchy is built from the whole picture. Of an
/// input that is no picture, and is passed on unchanged, only what is asked for.
GeglRectangle needed(GeglOperation* operation, const GeglRectangle* roi)
{
    const GeglRectangle box = whole_input(operation);
    return is_picture(box) ? box : *roi;
}

GeglRectangle get_required_for_output(GeglOperation* operation, const gchar*, const GeglRectangle* roi)
{
    return needed(operation, roi);
}

GeglRectangle get_cached_region(GeglOperation* operation, const GeglRectangle* roi)
{
    return needed(operation, roi);
}

GeglRectangle get_invalidated_by_change(GeglOperation* operation, const gchar*, const GeglRectangle*)
{
    return whole_input(operation);
}

/// Names the primaries of the format in OpenEXR's attribute. Without it they are those of sRGB.
void declare_primaries(OIIO::ImageSpec& spec, const Babl* format)
{
    const Babl* space = babl_format_get_space(format);
    if (space == babl_space("sRGB"))
        return;
    double xy[8];
    babl_space_get(space, &xy[6], &xy[7], &xy[0], &xy[1], &xy[2], &xy[3], &xy[4], &xy[5], nullptr, nullptr, nullptr);
    float chromaticities[8];
    std::copy(std::begin(xy), std::end(xy), chromaticities);
    spec.attribute("chromaticities", OIIO::TypeDesc(OIIO::TypeDesc::FLOAT, 8), chromaticities);
}

OIIO::ImageBuf pixels_of(GeglBuffer* input, const GeglRectangle& box, const Babl* format)
{
    OIIO::ImageSpec spec(box.width, box.height, 4, OIIO::TypeFloat);
    spec.x = box.x;
    spec.y = box.y;
    declare_primaries(spec, format);
    OIIO::ImageBuf pixels(spec);
    gegl_buffer_get(input, &box, 1.0, format, pixels.localpixels(), GEGL_AUTO_ROWSTRIDE, GEGL_ABYSS_NONE);
    return pixels;
}

/// Finds the progressive image of these pixels: the one of the last time if the pixels are the same, else a new one.
bool find_image(State& state, const OIIO::ImageBuf& pixels, const pimg::BuildOptions& build,
                pimg::ProgressiveImage& image, std::string& error)
{
    const std::string_view bytes(static_cast<const char*>(pixels.localpixels()), pixels.spec().image_bytes());
    const std::size_t fingerprint = std::hash<std::string_view>()(bytes);
    {
        const std::lock_guard<std::mutex> lock(state.mutex);
        if (state.image.initialized() && state.fingerprint == fingerprint && state.image.spec().roi() == pixels.roi()
            && pimg::same_options(state.build, build)) {
            image = state.image;
            return true;
        }
    }
    if (!image.build(pixels, build)) {
        error = image.error();
        return false;
    }
    const std::lock_guard<std::mutex> lock(state.mutex);
    state.image = image;
    state.fingerprint = fingerprint;
    state.build = build;
    return true;
}

/// Moves the properties that are options of building out of `texts`.
bool take_build_options(pimg::OptionTexts& texts, pimg::BuildOptions& build, std::string& error)
{
    const auto first =
        std::stable_partition(texts.begin(), texts.end(), [](auto& text) { return text.first != kWrap; });
    for (auto text = first; text != texts.end(); ++text)
        if (!pimg::set_option(build, text->first, text->second, error))
            return false;
    texts.erase(first, texts.end());
    return true;
}

bool render(Operation* self, GeglBuffer* input, GeglBuffer* output, const GeglRectangle& roi, std::string& error)
{
    GeglOperation* operation = GEGL_OPERATION(self);
    State& state = *self->state;
    const Babl* format = pixel_format(operation);
    pimg::BoundFilter filter;
    pimg::ProgressiveImage image;
    pimg::BuildOptions build;
    pimg::OptionTexts texts = state.texts_now();
    if (!take_build_options(texts, build, error) || !class_of(self)->filter->bind(texts, filter, error)
        || !find_image(state, pixels_of(input, whole_input(operation), format), build, image, error))
        return false;
    OIIO::ImageSpec spec(roi.width, roi.height, 4, OIIO::TypeFloat);
    spec.x = roi.x;
    spec.y = roi.y;
    OIIO::ImageBuf result(spec);
    if (!filter(result, image, result.roi(), 0)) {
        error = result.has_error() ? result.geterror() : "the filter failed";
        return false;
    }
    gegl_buffer_set(output, &roi, 0, format, result.localpixels(), GEGL_AUTO_ROWSTRIDE);
    return true;
}

gboolean process(GeglOperation* operation, GeglBuffer* input, GeglBuffer* output, const GeglRectangle* roi, gint)
{
    std::string error;
    try {
        if (render(operation_of(operation), input, output, *roi, error))
            return TRUE;
    } catch (const std::exception& exception) {
        error = exception.what();
    }
    g_warning("%s: %s", GEGL_OPERATION_GET_CLASS(operation)->name, pimg::one_line(error).c_str());
    return FALSE;
}

/// Calls process(). An input without end or without pixels is passed on as it is.
gboolean process_or_pass(GeglOperation* operation, GeglOperationContext* context, const gchar* property,
                         const GeglRectangle* roi, gint level)
{
    if (is_picture(whole_input(operation)))
        return GEGL_OPERATION_CLASS(parent_class)->process(operation, context, property, roi, level);
    g_message("%s: the input has no pixels or no end, and is passed on unchanged; gegl:crop before it makes a picture "
              "of it",
              GEGL_OPERATION_GET_CLASS(operation)->name);
    GObject* input = gegl_operation_context_get_object(context, "input");
    if (input != nullptr)
        gegl_operation_context_take_object(context, "output", G_OBJECT(g_object_ref(input)));
    return TRUE;
}

// ---- classes ----------------------------------------------------------------------------------------------

void finalize(GObject* object)
{
    delete operation_of(object)->state;
    G_OBJECT_CLASS(parent_class)->finalize(object);
}

void init_instance(GTypeInstance* instance, gpointer)
{
    operation_of(instance)->state = new State;
}

void init_class(gpointer klass, gpointer filter)
{
    parent_class = g_type_class_peek_parent(klass);
    auto* self = static_cast<OperationClass*>(klass);
    self->filter = static_cast<const Filter*>(filter);
    self->options = new std::vector<OptionInfo>(self->filter->options());
    for (const OptionInfo& option : pimg::describe_options<pimg::BuildOptions>())
        if (option.key == kWrap)
            self->options->push_back(option);

    GObjectClass* object = G_OBJECT_CLASS(klass);
    object->set_property = set_property;
    object->get_property = get_property;
    object->finalize = finalize;
    guint id = 0;
    for (const OptionInfo& option : *self->options) {
        g_object_class_install_property(object, ++id, property(option, G_PARAM_CONSTRUCT));
        OptionInfo older = option;
        older.key = option.alias;
        if (!older.key.empty())
            g_object_class_install_property(object, id, property(older, G_PARAM_DEPRECATED));
    }

    GeglOperationClass* operation = GEGL_OPERATION_CLASS(klass);
    operation->prepare = prepare;
    operation->get_required_for_output = get_required_for_output;
    operation->get_cached_region = get_cached_region;
    operation->get_invalidated_by_change = get_invalidated_by_change;
    operation->process = process_or_pass;
    operation->threaded = FALSE;  // the filter uses threads itself
    GEGL_OPERATION_FILTER_CLASS(klass)->process = process;
    // No licence is stated: GEGL hides operations whose licence is not on its list.
    const std::string name = "pimg:" + dashed(self->filter->name);
    const std::string title = pimg::title_of(*self->filter), summary = pimg::label_of(self->filter->summary);
    gegl_operation_class_set_keys(operation, "name", name.c_str(), "title", title.c_str(), "categories", "pimg",
                                  "description", summary.c_str(), nullptr);
}

const GeglModuleInfo kModuleInfo = { GEGL_MODULE_ABI_VERSION };

}  // namespace

extern "C" {

G_MODULE_EXPORT const GeglModuleInfo* gegl_module_query(GTypeModule*)
{
    return &kModuleInfo;
}

G_MODULE_EXPORT gboolean gegl_module_register(GTypeModule* module)
{
    for (const Filter& filter : pimg::filter_table()) {
        if (filter.output == pimg::FilterOutput::labels)
            continue;  // labels are no picture
        GTypeInfo info = {};
        info.class_size = sizeof(OperationClass);
        info.class_init = init_class;
        info.class_data = &filter;
        info.instance_size = sizeof(Operation);
        info.instance_init = init_instance;
        const std::string name = std::string("pimg_gegl_") + filter.name;
        g_type_module_register_type(module, GEGL_TYPE_OPERATION_FILTER, name.c_str(), &info, GTypeFlags(0));
    }
    return TRUE;
}
}
