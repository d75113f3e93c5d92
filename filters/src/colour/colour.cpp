// SPDX-License-Identifier: BSD-3-Clause
#include <pimg/colour.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <map>
#include <utility>

#include <OpenColorIO/OpenColorIO.h>

#include <pimg/detail/oiio_compat.h>
#include <pimg/detail/rec709.h>
#include <pimg/display.h>

#include "colour/colour_config.h"
#include "colour/icc.h"
#include "colour/layers.h"
#include "colour/primaries.h"
#include "colour/spaces.h"

namespace OCIO = OCIO_NAMESPACE;

namespace pimg {
inline namespace PIMG_ABI {

struct Colour::Decoder {
    OCIO::ConstCPUProcessorRcPtr cpu;
};

namespace {

using Weights = std::array<float, 3>;
using elementary::kRec709Weights;

/// Matrices whose elements differ by less than this, half of an 8-bit code, count as the same: configurations and files
/// hold rounded numbers.
constexpr double kSameMatrix = 2e-3;

std::string lower(std::string text)
{
    std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return char(std::tolower(c)); });
    return text;
}

bool is_one_of(const std::string& word, std::initializer_list<const char*> words)
{
    return std::any_of(words.begin(), words.end(), [&](const char* w) { return word == w; });
}

/// The configuration for processors made from transforms of our own, whatever $OCIO says. It adds no conversion.
const OCIO::ConstConfigRcPtr& raw_config()
{
    static const OCIO::ConstConfigRcPtr config = OCIO::Config::CreateRaw();
    return config;
}

/// Without the approximations of logarithms and powers by which versions of OpenColorIO differ: one in 70000 of a stop makes
/// another hierarchy.
OCIO::ConstCPUProcessorRcPtr cpu(const OCIO::ConstProcessorRcPtr& processor)
{
    return processor->getOptimizedCPUProcessor(
        OCIO::OptimizationFlags(OCIO::OPTIMIZATION_DEFAULT & ~OCIO::OPTIMIZATION_FAST_LOG_EXP_POW));
}

/// Applies a processor to each of `count` numbers, three at a time as if they were pixels, since OpenColorIO has no
/// pictures of one channel.
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

/// From a space of the configuration to Rec. 709, by way of a space that is known to have these primaries. False if the
/// configuration has none such or one of the two is not linear.
bool matrix_through(const OCIO::ConstConfigRcPtr& config, const char* space, const char* known,
                    const Chromaticities& primaries, Imath::M33d& matrix)
{
    const OCIO::ConstColorSpaceRcPtr to = config->getColorSpace(known);
    if (to == nullptr || to->getReferenceSpaceType() != OCIO::REFERENCE_SPACE_SCENE)
        return false;
    const auto processor = cpu(config->getProcessor(space, to->getName()));
    if (!is_linear(processor))
        return false;
    Imath::M33d to_known, known_matrix, inverse;
    for (std::size_t i = 0; i < 3; ++i) {
        float unit[3] = { 0.0f, 0.0f, 0.0f };
        unit[i] = 1.0f;
        processor->applyRGB(unit);
        for (std::size_t j = 0; j < 3; ++j)
            to_known[int(i)][j] = double(unit[j]);
    }
    if (!matrix_to_rec709(primaries, known_matrix))
        return false;
    matrix = to_known * known_matrix;
    return invert(matrix, inverse);
}

/// From a linear space of the configuration to Rec. 709; see Colour::resolve().
bool matrix_of(const OCIO::ConstConfigRcPtr& config, const char* space, Imath::M33d& matrix)
{
    const bool found = matrix_through(config, space, "aces_interchange", kAp0, matrix)
        || matrix_through(config, space, "cie_xyz_d65_interchange", kXyzD65, matrix)
        || matrix_through(config, space, "XYZ", kXyzD65, matrix);
    NamedSpace named;
    if (!found && find_named_space(lower(config->getColorSpace(space)->getName()), named) && named.linear())
        return matrix_to_rec709(named.primaries, matrix);
    if (const Chromaticities* known = found ? known_primaries(matrix, kSameMatrix) : nullptr)
        return matrix_to_rec709(*known, matrix);
    return found;
}

OCIO::TransformRcPtr curve(double gamma, double offset)
{
    if (offset == 0.0) {
        const auto transform = OCIO::ExponentTransform::Create();
        transform->setValue({ gamma, gamma, gamma, 1.0 });
        return transform;
    }
    const auto transform = OCIO::ExponentWithLinearTransform::Create();
    transform->setGamma({ gamma, gamma, gamma, 1.0 });
    transform->setOffset({ offset, offset, offset, 0.0 });
    return transform;
}

OCIO::TransformRcPtr curves(const std::array<std::vector<float>, 3>& samples)
{
    const std::size_t length = samples[0].size();
    const auto transform = OCIO::Lut1DTransform::Create((unsigned long)(length), false);
    transform->setInterpolation(OCIO::INTERP_LINEAR);
    for (std::size_t i = 0; i < length; ++i)
        transform->setValue((unsigned long)(i), samples[0][i], samples[1][i], samples[2][i]);
    return transform;
}

OCIO::TransformRcPtr matrix_transform(const Imath::M33d& matrix)
{
    const Imath::M33d m = matrix.transposed();  // matrices of OpenColorIO act on columns
    const double rows[16] = { m[0][0], m[0][1], m[0][2], 0, m[1][0], m[1][1], m[1][2], 0,
                              m[2][0], m[2][1], m[2][2], 0, 0,       0,       0,       1 };
    const auto transform = OCIO::MatrixTransform::Create();
    transform->setMatrix(rows);
    return transform;
}

bool says_only_linear(const std::string& name)
{
    return is_one_of(name, { "", "linear", "scene_linear" });
}

std::vector<float> to_floats(const Chromaticities& primaries)
{
    return { primaries.begin(), primaries.end() };
}

void multiply(const std::array<float, 9>& m, float* rgb, std::size_t count)
{
    const Imath::M33f matrix(m[0], m[1], m[2], m[3], m[4], m[5], m[6], m[7], m[8]);
    for (float* p = rgb; p != rgb + 3 * count; p += 3) {
        const Imath::V3f product = Imath::V3f(p[0], p[1], p[2]) * matrix;
        std::copy(&product.x, &product.x + 3, p);
    }
}

std::array<float, 9> to_floats(const Imath::M33d& matrix)
{
    std::array<float, 9> result;
    std::copy(matrix[0], matrix[0] + 9, result.begin());
    return result;
}

}  // namespace

/// The steps of Colour::resolve().
struct ColourFinder {
    Colour& colour;
    OCIO::ConstConfigRcPtr config;  ///< or null

    void set_decoder(const OCIO::ConstCPUProcessorRcPtr& processor)
    {
        colour.m_decoder = std::make_shared<Colour::Decoder>(Colour::Decoder { processor });
    }

    /// Linear samples have the primaries of this matrix, which leads to Rec. 709.
    void set_matrix(const Imath::M33d& to_rec709)
    {
        Imath::M33d inverse;
        colour.m_converts = !to_rec709.equalWithAbsError(Imath::M33d(), kSameMatrix) && invert(to_rec709, inverse);
        colour.m_weights = kRec709Weights;
        if (!colour.m_converts)
            return;
        colour.m_to_rec709 = to_floats(to_rec709);
        colour.m_from_rec709 = to_floats(inverse);
        const Imath::V3d rec709(kRec709Weights[0], kRec709Weights[1], kRec709Weights[2]);
        const Imath::V3d weights = rec709 * to_rec709.transposed();
        colour.m_weights = { float(weights.x), float(weights.y), float(weights.z) };
    }

    bool set_primaries(const Chromaticities& primaries)
    {
        Imath::M33d matrix;
        if (!matrix_to_rec709(primaries, matrix))
            return false;
        set_matrix(matrix);
        colour.m_chromaticities = to_floats(primaries);
        return true;
    }

    /// Samples are linear, in a space of the configuration.
    void use_linear_space(const char* name)
    {
        Imath::M33d matrix;
        colour.m_linear_name = config->getColorSpace(name)->getName();
        if (matrix_of(config, name, matrix)) {
            set_matrix(matrix);
            const Chromaticities* known = known_primaries(matrix, kSameMatrix);
            if (known != nullptr && colour.m_converts)
                colour.m_chromaticities = to_floats(*known);
            return;
        }
        double luma[3];
        config->getDefaultLumaCoefs(luma);
        for (std::size_t i = 0; i < 3; ++i)
            colour.m_weights[i] = float(luma[i]);
    }

    bool has_scene_linear() const { return config != nullptr && config->hasRole(OCIO::ROLE_SCENE_LINEAR); }

    /// Samples are scene-linear: in the space of the role scene_linear if there is a configuration.
    void use_scene_linear()
    {
        if (has_scene_linear())
            use_linear_space(OCIO::ROLE_SCENE_LINEAR);
    }

    /// The same, without any conversion of the stored samples.
    bool use_samples_as_scene_linear()
    {
        use_scene_linear();
        colour.m_config_name = has_scene_linear() ? colour.m_linear_name : "linear";
        return true;
    }

    /// Samples become linear by `decoder`, with these primaries. If there is a configuration, they are then converted
    /// to its scene-linear space.
    bool use_encoded(const OCIO::TransformRcPtr& decoder, const Chromaticities& primaries)
    {
        Imath::M33d own, working, from_rec709;
        if (!matrix_to_rec709(primaries, own))
            return false;
        const auto group = OCIO::GroupTransform::Create();
        group->appendTransform(decoder);
        if (has_scene_linear() && matrix_of(config, OCIO::ROLE_SCENE_LINEAR, working) && invert(working, from_rec709)) {
            if (!own.equalWithAbsError(working, kSameMatrix))
                group->appendTransform(matrix_transform(own * from_rec709));
            use_scene_linear();
        } else if (!own.equalWithAbsError(Imath::M33d(), kSameMatrix))
            set_primaries(primaries);
        set_decoder(cpu(raw_config()->getProcessor(group)));
        return true;
    }

    /// Samples are sRGB, by the name that the configuration has for it, so that primaries are converted, too.
    bool use_config_srgb()
    {
        for (const char* name : { "sRGB", "sRGB - Texture", "srgb_texture", "srgb_tx", "Utility - sRGB - Texture",
                                  "sRGB Encoded Rec.709 (sRGB)", "srgb_rec709_scene" })
            if (use_config_space(name))
                return true;
        return false;
    }

    bool use_config_space(const std::string& name)
    {
        const OCIO::ConstColorSpaceRcPtr space = config == nullptr ? nullptr : config->getColorSpace(name.c_str());
        if (space == nullptr)
            return false;
        colour.m_config_name = space->getName();
        if (!space->isData() && has_scene_linear()) {
            const auto to_linear = cpu(config->getProcessor(space->getName(), OCIO::ROLE_SCENE_LINEAR));
            if (!is_linear(to_linear)) {
                set_decoder(to_linear);
                use_scene_linear();
                return true;
            }
        }
        use_linear_space(space->getName());
        return true;
    }

    bool use_own_space(const std::string& name)
    {
        NamedSpace space;
        if (is_one_of(lower(name), { "linear", "scene_linear" }))
            return use_samples_as_scene_linear();
        if (names_srgb(lower(name)) && use_config_srgb())
            return true;
        if (!find_named_space(lower(name), space))
            return false;
        if (config == nullptr && space.primaries == kRec709)  // as OpenImageIO calls these
            colour.m_config_name = names_srgb(lower(name)) ? "sRGB"
                : lower(name) == "rec709"                  ? "Rec709"
                : space.linear()                           ? "linear"
                                                           : "";
        if (!space.linear())
            return use_encoded(curve(space.gamma, space.offset), space.primaries);
        colour.m_linear_name = name;
        return set_primaries(space.primaries);
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
        Imath::M33d own, working;
        if (!matrix_to_rec709(c, own))
            return false;
        const bool comparable = !has_scene_linear() || matrix_of(config, OCIO::ROLE_SCENE_LINEAR, working);
        if (comparable && own.equalWithAbsError(working, kSameMatrix))
            use_samples_as_scene_linear();
        set_matrix(own);
        colour.m_chromaticities.assign(stored, stored + 8);
        return true;
    }

    bool find_channels(const OIIO::ImageSpec& spec, const std::string& layer, std::string& error)
    {
        PictureChannels picture;
        if (!find_picture(spec, layer, picture, error))
            return false;
        colour.m_channels = picture.channels;
        colour.m_count = picture.count;
        colour.m_alpha = picture.alpha;
        return true;
    }

    /// Pictures with fewer than three colour channels: the first is the luminance.
    void use_first_channel()
    {
        if (colour.m_count >= 3)
            return;
        colour.m_weights = { 1.0f, 0.0f, 0.0f };
        colour.m_converts = false;
    }

    /// Whether the name of a space only repeats the gamma that a PNG file gives, which an ICC profile has precedence over.
    static bool says_only_gamma(const OIIO::ImageSpec& spec, const std::string& name)
    {
        NamedSpace space;  // linear light, if the name says only that
        const double gamma = double(spec.get_float_attribute("oiio:Gamma"));
        return gamma > 0.0 && (says_only_linear(lower(name)) || find_named_space(lower(name), space))
            && space.offset == 0.0 && space.primaries == kRec709 && std::fabs(space.gamma - gamma) < 0.06;
    }

    /// An ICC profile counts if the metadata name no space, or only the one that files of the format usually are in.
    bool use_icc(const OIIO::ImageSpec& spec, const std::string& name)
    {
        const OIIO::ParamValue* attribute = spec.find_attribute("ICCProfile");
        const bool is_usual = name.empty() || names_srgb(lower(name)) || says_only_gamma(spec, name);
        IccSpace icc;
        if (attribute == nullptr || !is_usual || !read_icc(attribute->data(), std::size_t(attribute->datasize()), icc))
            return false;
        if (icc.srgb)
            use_own_space("sRGB");
        else if (icc.linear)
            set_primaries(icc.primaries);
        else
            use_encoded(curves(icc.curves), icc.primaries);
        colour.m_description = "its ICC profile says, " + (icc.name.empty() ? "of no name" : icc.name);
        return true;
    }

    /// Code points of ITU-T H.273, as PNG files have them. Unknown ones are no error.
    bool use_cicp(const OIIO::ImageSpec& spec)
    {
        const OIIO::ParamValue* attribute = spec.find_attribute("CICP");
        if (attribute == nullptr || attribute->type().basetype != OIIO::TypeDesc::INT
            || attribute->type().basevalues() != 4)
            return false;
        const int* code = static_cast<const int*>(attribute->data());
        static const std::map<int, Chromaticities> primaries { { 1, kRec709 }, { 9, kRec2020 }, { 12, kP3 } };
        static const std::map<int, std::pair<double, double>> transfers {
            { 1, { kRec709Gamma, kRec709Offset } },
            { 6, { kRec709Gamma, kRec709Offset } },
            { 14, { kRec709Gamma, kRec709Offset } },
            { 15, { kRec709Gamma, kRec709Offset } },
            { 4, { 2.2, 0.0 } },
            { 8, { 1.0, 0.0 } },
            { 13, { kSrgbGamma, kSrgbOffset } },
        };
        const auto colours = primaries.find(code[0]);
        const auto transfer = transfers.find(code[1]);
        if (colours == primaries.end() || transfer == transfers.end())
            return false;
        const auto [gamma, offset] = transfer->second;
        if (gamma == 1.0)
            set_primaries(colours->second);
        else if (code[0] == 1 && code[1] == 13)
            use_own_space("sRGB");
        else
            use_encoded(curve(gamma, offset), colours->second);
        colour.m_description = "its CICP says";
        return true;
    }

    /// From the picture's own metadata and type.
    void use_metadata(const OIIO::ImageSpec& spec)
    {
        std::string name = spec.get_string_attribute("oiio:ColorSpace");
        // OpenImageIO 2 calls every file of the PNM family Rec709, the floats of a PFM among them, which are linear.
        const bool is_pfm = spec.format.is_floating_point() && spec.find_attribute("pnm:bigendian") != nullptr;
        if (is_pfm && lower(name) == "rec709")
            name.clear();
        if (says_only_linear(lower(name)))
            name = spec.get_string_attribute("colorInteropID", name);
        if ((name.empty() || names_srgb(lower(name))) && use_cicp(spec))
            return;
        if (use_icc(spec, name))
            return;
        if (!says_only_linear(lower(name)) && (use_config_space(name) || use_own_space(name))) {
            colour.m_description = name + ", as its metadata say";
            return;
        }
        const bool whole_numbers = !spec.format.is_floating_point();
        if (whole_numbers && (name.empty() || !says_only_linear(lower(name)))) {
            use_own_space("sRGB");
            colour.m_description = "sRGB, as whole numbers are";
        } else if (use_chromaticities(spec)) {
            colour.m_description = "linear light with the chromaticities of its metadata";
        } else {
            use_samples_as_scene_linear();
            const std::string primaries = has_scene_linear() ? colour.m_linear_name : "Rec. 709";
            const char* reason = whole_numbers ? "as its metadata say" : "as floating-point numbers are";
            colour.m_description = "linear light in " + primaries + ", " + reason;
        }
    }
};

std::string space_by_file_rule(const std::string& filename)
{
    try {
        const OCIO::ConstConfigRcPtr config = current_colour_config();
        // Those that come with OpenColorIO say of every .exr that it is ACES2065-1. OpenImageIO takes no notice either.
        if (config == nullptr || name_of_colour_config().rfind("ocio://", 0) == 0
            || config->filepathOnlyMatchesDefaultRule(filename.c_str()))
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
        current_colour_config();
        return true;
    } catch (const OCIO::Exception& exception) {
        error = source_of_colour_config() + ": " + exception.what();
        return false;
    }
}

bool Colour::resolve(const OIIO::ImageSpec& spec, const std::string& space, const std::string& layer, Colour& colour,
                     std::string& error)
{
    try {
        Colour found;
        found.m_linear_name = kDeclaredLinear;
        ColourFinder finder { found, current_colour_config() };
        if (!finder.find_channels(spec, layer, error))
            return false;
        if (space.empty()) {
            finder.use_metadata(spec);
        } else if (!finder.use_config_space(space) && !finder.use_own_space(space)) {
            error = "incolorspace=\"" + space
                + "\": expected a colour space of the OpenColorIO configuration, or linear,"
                  " srgb, rec709, gamma2.2, acescg, aces2065-1, lin_rec2020 or the like";
            return false;
        } else {
            found.m_description = space + ", as told";
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

void Colour::to_rec709(float* rgb, std::size_t count) const
{
    if (m_converts)
        multiply(m_to_rec709, rgb, count);
}

void Colour::from_rec709(float* rgb, std::size_t count) const
{
    if (m_converts)
        multiply(m_from_rec709, rgb, count);
}

bool Colour::to_scene_linear(float* rgb, std::size_t count) const
{
    try {
        Colour working;
        ColourFinder { working, current_colour_config() }.use_scene_linear();
        decode(rgb, count);
        if (m_to_rec709 != working.m_to_rec709) {
            to_rec709(rgb, count);
            working.from_rec709(rgb, count);
        }
        return true;
    } catch (const OCIO::Exception&) {
        return false;  // `error` tells already that the configuration cannot be read
    }
}

bool holds_data(const OIIO::ImageSpec& spec, int channel, const Colour& colour)
{
    return !colour.is_colour(channel) && channel != colour.alpha() && holds_data(spec, channel);
}

void Colour::declare_linear(OIIO::ImageSpec& spec) const
{
    if (m_chromaticities.size() != 8) {
        declare_space(spec, m_linear_name);
        return;
    }
    Chromaticities primaries;
    std::copy(m_chromaticities.begin(), m_chromaticities.end(), primaries.begin());
    declare_space(spec, m_linear_name == kDeclaredLinear ? with_primaries(kDeclaredLinear, primaries) : m_linear_name);
    spec.attribute("chromaticities", OIIO::TypeDesc(OIIO::TypeDesc::FLOAT, 8), m_chromaticities.data());
}

void log2_in_place(float* values, std::size_t count)
{
    static const OCIO::ConstCPUProcessorRcPtr processor = log2_processor();
    apply_to_scalars(processor, values, count);
}

}  // namespace PIMG_ABI
}  // namespace pimg
