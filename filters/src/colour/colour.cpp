// SPDX-License-Identifier: BSD-3-Clause
#include <pimg/colour.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdlib>
#include <mutex>
#include <utility>

#include <OpenColorIO/OpenColorIO.h>

namespace OCIO = OCIO_NAMESPACE;

namespace pimg {

struct Colour::Decoder {
    OCIO::ConstCPUProcessorRcPtr cpu;
};

namespace {

using Weights = std::array<float, 3>;

/// xy of R, G, B and white.
using Chromaticities = std::array<double, 8>;

constexpr Chromaticities kRec709 { 0.64, 0.33, 0.30, 0.60, 0.15, 0.06, 0.3127, 0.3290 };
constexpr Chromaticities kRec2020 { 0.708, 0.292, 0.170, 0.797, 0.131, 0.046, 0.3127, 0.3290 };
constexpr Chromaticities kP3 { 0.680, 0.320, 0.265, 0.690, 0.150, 0.060, 0.3127, 0.3290 };
constexpr Chromaticities kAp0 { 0.7347, 0.2653, 0.0, 1.0, 0.0001, -0.077, 0.32168, 0.33767 };
constexpr Chromaticities kAp1 { 0.713, 0.293, 0.165, 0.830, 0.128, 0.044, 0.32168, 0.33767 };

std::string lower(std::string text)
{
    std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return char(std::tolower(c)); });
    return text;
}

bool is_one_of(const std::string& word, std::initializer_list<const char*> words)
{
    return std::any_of(words.begin(), words.end(), [&](const char* w) { return word == w; });
}

/// The configuration engine-owned processors come from, whatever $OCIO says: it makes no conversion of its own.
const OCIO::ConstConfigRcPtr& raw_config()
{
    static const OCIO::ConstConfigRcPtr config = OCIO::Config::CreateRaw();
    return config;
}

OCIO::ConstCPUProcessorRcPtr cpu(const OCIO::ConstProcessorRcPtr& processor)
{
    return processor->getDefaultCPUProcessor();
}

/// The configuration of $OCIO, read once per value of that variable; null when it is not set. Without the test
/// OpenColorIO would print that colour management is disabled.
OCIO::ConstConfigRcPtr environment_config()
{
    static std::mutex mutex;
    static std::pair<std::string, OCIO::ConstConfigRcPtr> cached;
    const char* name = std::getenv("OCIO");
    if (name == nullptr || *name == '\0')
        return nullptr;
    std::lock_guard<std::mutex> lock(mutex);
    if (cached.first != name)
        cached = { name, OCIO::Config::CreateFromFile(name) };
    return cached.second;
}

/// Applies a processor to a run of numbers, three to a pixel: OpenColorIO takes no single channels.
void apply_to_scalars(const OCIO::ConstCPUProcessorRcPtr& processor, float* values, std::size_t count)
{
    const std::size_t pixels = count / 3;
    if (pixels > 0) {
        OCIO::PackedImageDesc image(values, long(pixels), 1, 3);
        processor->apply(image);
    }
    float last[3] = { 1.0f, 1.0f, 1.0f };
    std::copy(values + 3 * pixels, values + count, last);
    processor->applyRGB(last);
    std::copy(last, last + (count - 3 * pixels), values + 3 * pixels);
}

OCIO::ConstCPUProcessorRcPtr log2_processor()
{
    const auto transform = OCIO::LogTransform::Create();
    transform->setBase(2.0);
    return cpu(raw_config()->getProcessor(transform));
}

/// Luminance of RGB with the given primaries: the Y row of its matrix to CIE XYZ, which is what R, G and B
/// must weigh for their sum to be white. False for degenerate primaries.
bool weights_of(const Chromaticities& c, Weights& weights)
{
    const auto cross = [](double ax, double ay, double bx, double by) {
        return ax * by - ay * bx;
    };
    double sum = 0.0;
    std::array<double, 3> y {};
    for (int i = 0; i < 3; ++i) {
        // Share of primary i in white, by barycentric coordinates in xy, then scaled to white's Y.
        const int j = (i + 1) % 3, k = (i + 2) % 3;
        const double xj = c[2 * j], yj = c[2 * j + 1], xk = c[2 * k], yk = c[2 * k + 1];
        const double area = cross(xj - c[2 * i], yj - c[2 * i + 1], xk - c[2 * i], yk - c[2 * i + 1]);
        const double share = cross(xj - c[6], yj - c[7], xk - c[6], yk - c[7]);
        y[std::size_t(i)] = share / area * c[2 * i + 1];
        sum += y[std::size_t(i)];
    }
    for (std::size_t i = 0; i < 3; ++i)
        weights[i] = float(y[i] / sum);
    return std::all_of(weights.begin(), weights.end(), [](float w) { return std::isfinite(w); });
}

/// Whether the processor only scales: f(1000 x) = 1000 f(x), tried on grey.
bool is_linear(const OCIO::ConstCPUProcessorRcPtr& processor)
{
    float low[3] = { 0.18f, 0.18f, 0.18f }, high[3] = { 180.0f, 180.0f, 180.0f };
    processor->applyRGB(low);
    processor->applyRGB(high);
    for (int i = 0; i < 3; ++i)
        if (!(std::fabs(high[i] - 1000.0f * low[i]) <= 0.01f * std::fabs(high[i])))
            return false;
    return true;
}

/// Y of red, green and blue of a space, by a linear conversion to a space where Y is `y` times its components.
bool weights_through(const OCIO::ConstConfigRcPtr& config, const char* space, const char* known, const Weights& y,
                     Weights& weights)
{
    const OCIO::ConstColorSpaceRcPtr to = config->getColorSpace(known);
    if (to == nullptr || to->getReferenceSpaceType() != OCIO::REFERENCE_SPACE_SCENE)
        return false;
    const auto processor = cpu(config->getProcessor(space, to->getName()));
    if (!is_linear(processor))
        return false;
    for (std::size_t i = 0; i < 3; ++i) {
        float unit[3] = { 0.0f, 0.0f, 0.0f };
        unit[i] = 1.0f;
        processor->applyRGB(unit);
        weights[i] = y[0] * unit[0] + y[1] * unit[1] + y[2] * unit[2];
    }
    const float sum = weights[0] + weights[1] + weights[2];
    for (float& w : weights)
        w /= sum;
    return std::isfinite(weights[0] + weights[1] + weights[2]);
}

/// Primaries of linear spaces known by name; false for other names.
bool weights_by_name(const std::string& name, Weights& weights)
{
    if (is_one_of(name, { "acescg", "aces - acescg", "lin_ap1", "lin_ap1_scene" }))
        return weights_of(kAp1, weights);
    if (is_one_of(name, { "aces2065-1", "aces - aces2065-1", "lin_ap0", "lin_ap0_scene", "aces" }))
        return weights_of(kAp0, weights);
    return false;
}

/// The weights of well-known primaries that these are within a hundredth of, else these: a conversion between whites,
/// which shifts them a little, is no property of the primaries.
Weights without_adaptation(const Weights& found)
{
    Weights nearest = found;
    float least = 0.01f;
    for (const Chromaticities& primaries : { kRec709, kRec2020, kP3, kAp0, kAp1 }) {
        Weights known;
        weights_of(primaries, known);
        float distance = 0.0f;
        for (std::size_t i = 0; i < 3; ++i)
            distance = std::max(distance, std::fabs(known[i] - found[i]));
        if (distance < least) {
            least = distance;
            nearest = known;
        }
    }
    return nearest;
}

/// Luminance weights of a linear space of the configuration; see Colour::resolve().
Weights weights_of(const OCIO::ConstConfigRcPtr& config, const char* space)
{
    Weights weights, ap0;
    weights_of(kAp0, ap0);
    if (weights_through(config, space, "aces_interchange", ap0, weights))
        return without_adaptation(weights);
    for (const char* xyz : { "cie_xyz_d65_interchange", "XYZ" })
        if (weights_through(config, space, xyz, { 0.0f, 1.0f, 0.0f }, weights))
            return without_adaptation(weights);
    if (weights_by_name(lower(config->getColorSpace(space)->getName()), weights))
        return weights;
    double luma[3];
    config->getDefaultLumaCoefs(luma);
    for (std::size_t i = 0; i < 3; ++i)
        weights[i] = float(luma[i]);
    return weights;
}

/// Decoder of an engine-owned transfer curve: ((v + offset) / (1 + offset))^gamma with a linear toe, or a plain power.
OCIO::ConstCPUProcessorRcPtr curve(double gamma, double offset)
{
    if (offset == 0.0) {
        const auto transform = OCIO::ExponentTransform::Create();
        transform->setValue({ gamma, gamma, gamma, 1.0 });
        return cpu(raw_config()->getProcessor(transform));
    }
    const auto transform = OCIO::ExponentWithLinearTransform::Create();
    transform->setGamma({ gamma, gamma, gamma, 1.0 });
    transform->setOffset({ offset, offset, offset, 0.0 });
    return cpu(raw_config()->getProcessor(transform));
}

/// "gamma2.2" and the like; 0 if the name is none.
double gamma_of(const std::string& name)
{
    if (name.rfind("gamma", 0) != 0 || name.size() < 6)
        return 0.0;
    const double gamma = std::strtod(name.c_str() + 5, nullptr);
    return gamma >= 0.1 && gamma <= 10.0 ? gamma : 0.0;
}

bool says_only_linear(const std::string& name)
{
    return is_one_of(name, { "", "linear", "scene_linear" });
}

}  // namespace

/// The steps of Colour::resolve().
struct ColourFinder {
    Colour& colour;
    OCIO::ConstConfigRcPtr config;  ///< of $OCIO, or null

    void set_decoder(const OCIO::ConstCPUProcessorRcPtr& processor)
    {
        colour.m_decoder = std::make_shared<Colour::Decoder>(Colour::Decoder { processor });
    }

    /// Scene-linear samples: the role of that name if there is a configuration.
    void use_scene_linear()
    {
        const char* role = OCIO::ROLE_SCENE_LINEAR;
        if (config == nullptr || !config->hasRole(role))
            return;
        colour.m_weights = weights_of(config, role);
        colour.m_linear_name = config->getColorSpace(role)->getName();
    }

    /// sRGB as the configuration calls it, so that its primaries are converted, too.
    bool use_config_srgb()
    {
        for (const char* name : { "sRGB", "sRGB - Texture", "srgb_texture", "srgb_tx", "Utility - sRGB - Texture" })
            if (use_config_space(name))
                return true;
        return false;
    }

    bool use_config_space(const std::string& name)
    {
        const OCIO::ConstColorSpaceRcPtr space = config == nullptr ? nullptr : config->getColorSpace(name.c_str());
        if (space == nullptr)
            return false;
        const bool has_role = config->hasRole(OCIO::ROLE_SCENE_LINEAR);
        if (!space->isData() && has_role) {
            const auto to_linear = cpu(config->getProcessor(space->getName(), OCIO::ROLE_SCENE_LINEAR));
            if (!is_linear(to_linear)) {
                set_decoder(to_linear);
                use_scene_linear();
                return true;
            }
        }
        colour.m_weights = weights_of(config, space->getName());
        colour.m_linear_name = space->getName();
        return true;
    }

    bool use_own_space(const std::string& name)
    {
        const double gamma = gamma_of(name);
        const bool is_srgb =
            is_one_of(name, { "srgb", "srgb_texture", "srgb_tx", "srgb - texture", "srgb_rec709_scene" });
        if (is_srgb && use_config_srgb())
            return true;
        if (is_srgb)
            set_decoder(curve(2.4, 0.055));
        else if (is_one_of(name, { "rec709", "rec.709" }))
            set_decoder(curve(1.0 / 0.45, 0.099));
        else if (gamma > 0.0)
            set_decoder(curve(gamma, 0.0));
        else if (is_one_of(name, { "linear", "scene_linear" }))
            use_scene_linear();
        else
            return weights_by_name(name, colour.m_weights)
                || is_one_of(name, { "lin_rec709", "lin_rec709_scene", "lin_srgb", "raw", "data" });
        return true;
    }

    bool use_chromaticities(const OIIO::ImageSpec& spec)
    {
        const OIIO::ParamValue* attribute = spec.find_attribute("chromaticities");
        if (attribute == nullptr || attribute->type().basetype != OIIO::TypeDesc::FLOAT
            || attribute->type().basevalues() != 8)
            return false;
        Chromaticities c;
        const float* stored = static_cast<const float*>(attribute->data());
        std::copy(stored, stored + 8, c.begin());
        Weights weights;
        if (!weights_of(c, weights))
            return false;
        colour.m_weights = weights;
        return true;
    }

    void find_channels(const OIIO::ImageSpec& spec)
    {
        std::array<int, 3> named { -1, -1, -1 };
        std::array<int, 3> first { -1, -1, -1 };
        int others = 0;
        for (int c = 0; c < spec.nchannels; ++c) {
            const std::string name = lower(spec.channel_name(c));
            for (std::size_t i = 0; i < 3; ++i)
                if (is_one_of(name, { i == 0 ? "r" : i == 1 ? "g" : "b", i == 0 ? "red" : i == 1 ? "green" : "blue" }))
                    named[i] = c;
            if (c != spec.alpha_channel && c != spec.z_channel && others < 3)
                first[std::size_t(others++)] = c;
        }
        if (others == 0)  // only alpha or depth: then that is the picture
            for (; others < std::min(spec.nchannels, 3); ++others)
                first[std::size_t(others)] = others;
        const bool is_rgb = *std::min_element(named.begin(), named.end()) >= 0;
        colour.m_channels = is_rgb ? named : first;
        colour.m_count = is_rgb ? 3 : others;
    }

    /// Pictures without three colours: the first is the luminance.
    void use_first_channel()
    {
        if (colour.m_count < 3)
            colour.m_weights = { 1.0f, 0.0f, 0.0f };
    }

    /// From the picture's own metadata and type.
    void use_metadata(const OIIO::ImageSpec& spec)
    {
        const std::string name = spec.get_string_attribute("oiio:ColorSpace");
        if (!says_only_linear(lower(name)) && (use_config_space(name) || use_own_space(lower(name))))
            return;
        if (spec.format == OIIO::TypeDesc::UINT8 && lower(name) != "linear")
            use_own_space("srgb");
        else if (!use_chromaticities(spec))
            use_scene_linear();
    }
};

std::string space_by_file_rule(const std::string& filename)
{
    try {
        const OCIO::ConstConfigRcPtr config = environment_config();
        if (config == nullptr || config->filepathOnlyMatchesDefaultRule(filename.c_str()))
            return {};
        const OCIO::ConstColorSpaceRcPtr space =
            config->getColorSpace(config->getColorSpaceFromFilepath(filename.c_str()));
        return space == nullptr ? "" : space->getName();
    } catch (const OCIO::Exception&) {
        return {};
    }
}

bool check_colour_config(std::string& error)
{
    try {
        environment_config();
        return true;
    } catch (const OCIO::Exception& exception) {
        error = std::string("$OCIO: ") + exception.what();
        return false;
    }
}

bool Colour::resolve(const OIIO::ImageSpec& spec, const std::string& space, Colour& colour, std::string& error)
{
    try {
        Colour found;
        ColourFinder finder { found, environment_config() };
        finder.find_channels(spec);
        if (space.empty()) {
            finder.use_metadata(spec);
        } else if (!finder.use_config_space(space) && !finder.use_own_space(lower(space))) {
            error = "incolorspace=\"" + space
                + "\": expected a colour space of the OpenColorIO configuration, or linear,"
                  " srgb, rec709, gamma2.2, acescg or aces2065-1";
            return false;
        }
        finder.use_first_channel();
        colour = std::move(found);
        return true;
    } catch (const OCIO::Exception& exception) {
        error = std::string("OpenColorIO: ") + exception.what();
        return false;
    }
}

bool Colour::is_colour(int channel) const
{
    return std::find(m_channels.begin(), m_channels.begin() + m_count, channel) != m_channels.begin() + m_count;
}

void Colour::decode(float* rgb, std::size_t count) const
{
    if (m_decoder == nullptr || count == 0)
        return;
    OCIO::PackedImageDesc image(rgb, long(count), 1, 3);
    m_decoder->cpu->apply(image);
}

void log2_in_place(float* values, std::size_t count)
{
    static const OCIO::ConstCPUProcessorRcPtr processor = log2_processor();
    apply_to_scalars(processor, values, count);
}

}  // namespace pimg
