// SPDX-License-Identifier: BSD-3-Clause
#include "gl/colour_shader.h"

#include <cmath>
#include <cstdlib>

#include <OpenColorIO/OpenColorIO.h>

#include <pimg/detail/format.h>

namespace pimgview {

namespace ocio = OCIO_NAMESPACE;
using pimg::format;

/// Textures of the processors, from unit 2 on.
struct ColourShader::Tables {
    struct Table {
        Texture texture;
        GLenum kind;
        std::string sampler;
    };

    void add(const ocio::GpuShaderDesc& shader);
    void add_cube(const ocio::GpuShaderDesc& shader, unsigned index);
    void add_curve(const ocio::GpuShaderDesc& shader, unsigned index);
    void begin(GLenum kind, const char* sampler, ocio::Interpolation interpolation);

    std::vector<Table> tables;
};

namespace {

const char kVertex[] = R"(#version 150
in vec4 corner;
out vec2 place;
void main() { gl_Position = vec4(corner.xy, 0.0, 1.0); place = corner.zw; }
)";

// NaN is found by comparisons, all of which it fails: drivers optimise isnan() away. What a pixel does not need is left
// out before compiling: software drivers compute both sides of every branch, which made a window take 70 ms, not 25.
const char kMain[] = R"(
uniform sampler2D result, source;
uniform float gain, inverse_gamma, boost, split_x;
in vec2 place;
out vec4 colour;

vec3 displayed(vec3 linear) { return to_display(vec4(linear * gain, 1.0)).rgb; }
vec3 linear_result() { return result_to_linear(vec4(texture(result, place).rgb, 1.0)).rgb; }
bool is_number(vec3 v) { return all(greaterThanEqual(v, vec3(-3.0e38))) && all(lessThanEqual(v, vec3(3.0e38))); }

#ifdef SHOW_SOURCE
vec3 linear_source() { return source_to_linear(vec4(texture(source, place).rgb, 1.0)).rgb; }
#endif

vec3 false_colour(vec3 linear, vec3 code)
{
    if (!is_number(linear)) return vec3(1.0, 1.0, 0.0);
    float most = max(linear.r, max(linear.g, linear.b));
    if (most <= 0.0) return vec3(0.0, 0.25, 1.0);
    if (min(linear.r, min(linear.g, linear.b)) < -0.001 * most) return vec3(1.0, 0.0, 1.0);
    if (max(code.r, max(code.g, code.b)) > 1.002) return vec3(1.0, 0.0, 0.0);
    return code;
}

vec3 shown(vec3 linear)
{
    vec3 code = displayed(linear);
#ifdef CLIPPED
    code = false_colour(linear, code);
#endif
#ifdef GAMMA
    code = pow(max(code, 0.0), vec3(inverse_gamma));
#endif
    return code;
}

void main()
{
#if defined(DIFFERENCE)
    vec3 a = displayed(linear_result()), b = displayed(linear_source());
    vec3 code = 0.5 + boost * (clamp(a, 0.0, 1.0) - clamp(b, 0.0, 1.0));
#elif defined(SPLIT)
    vec3 code = shown(gl_FragCoord.x < split_x ? linear_source() : linear_result());
    if (abs(gl_FragCoord.x - split_x) < 1.0) code = vec3(1.0, 0.6, 0.0);
#elif defined(SHOW_SOURCE)
    vec3 code = shown(linear_source());
#else
    vec3 code = shown(linear_result());
#endif
    colour = vec4(is_number(code) ? code : vec3(0.0), 1.0);
}
)";

/// The lines before kMain that say what is to be drawn.
std::string definitions(const LookOptions& look)
{
    std::string text;
    if (look.show != "result")
        text += "#define SHOW_SOURCE\n";
    if (look.show == "split")
        text += "#define SPLIT\n";
    if (look.show == "difference")
        text += "#define DIFFERENCE\n";
    if (look.clipped)
        text += "#define CLIPPED\n";
    if (look.gamma != 1.0f)
        text += "#define GAMMA\n";
    return text;
}

/// The curve of sRGB, straight below 0.
ocio::ConstTransformRcPtr srgb(ocio::TransformDirection direction)
{
    const auto curve = ocio::ExponentWithLinearTransform::Create();
    const double gamma[4] = { 2.4, 2.4, 2.4, 1.0 }, offset[4] = { 0.055, 0.055, 0.055, 0.0 };
    curve->setGamma(gamma);
    curve->setOffset(offset);
    curve->setNegativeStyle(ocio::NEGATIVE_LINEAR);
    curve->setDirection(direction);
    return curve;
}

ocio::ConstTransformRcPtr matrix(const std::array<float, 9>& rows)
{
    double m44[16] = {};
    for (std::size_t i = 0; i < 9; ++i)
        m44[i / 3 * 4 + i % 3] = double(rows[i]);
    m44[15] = 1.0;
    const auto transform = ocio::MatrixTransform::Create();
    transform->setMatrix(m44);
    return transform;
}

/// From numbers to linear light: with a display the scene-linear space of the configuration, otherwise that of Rec.
/// 709.
ocio::ConstProcessorRcPtr to_linear(const ocio::ConstConfigRcPtr& config, const Light& light, bool managed)
{
    const auto group = ocio::GroupTransform::Create();
    if (managed && !light.space.empty()) {
        const auto space = ocio::ColorSpaceTransform::Create();
        space->setSrc(light.space.c_str());
        space->setDst(ocio::ROLE_SCENE_LINEAR);
        group->appendTransform(space);
    } else {
        if (light.encoded)
            group->appendTransform(ocio::ConstTransformRcPtr(srgb(ocio::TRANSFORM_DIR_FORWARD))->createEditableCopy());
        group->appendTransform(matrix(light.to_rec709)->createEditableCopy());
    }
    return config->getProcessor(group);
}

ocio::ConstProcessorRcPtr to_display(const ocio::ConstConfigRcPtr& config, const std::string& display,
                                     const std::string& view)
{
    if (display.empty())
        return config->getProcessor(srgb(ocio::TRANSFORM_DIR_INVERSE));
    const auto transform = ocio::DisplayViewTransform::Create();
    transform->setSrc(ocio::ROLE_SCENE_LINEAR);
    transform->setDisplay(display.c_str());
    transform->setView(view.empty() ? config->getDefaultView(display.c_str()) : view.c_str());
    return config->getProcessor(transform);
}

ocio::ConstConfigRcPtr current_config()
{
    return std::getenv("OCIO") != nullptr ? ocio::GetCurrentConfig() : ocio::Config::CreateRaw();
}

}  // namespace

DisplayList display_list()
{
    DisplayList list;
    if (std::getenv("OCIO") == nullptr)
        return list;
    try {
        const ocio::ConstConfigRcPtr config = ocio::GetCurrentConfig();
        for (int d = 0; d < config->getNumDisplays(); ++d) {
            list.displays.emplace_back(config->getDisplay(d));
            list.views.emplace_back();
            for (int v = 0; v < config->getNumViews(config->getDisplay(d)); ++v)
                list.views.back().emplace_back(config->getView(config->getDisplay(d), v));
        }
    } catch (const ocio::Exception&) {
        list = {};  // the picture's error says that $OCIO cannot be read
    }
    return list;
}

void ColourShader::Tables::begin(GLenum kind, const char* sampler, ocio::Interpolation interpolation)
{
    tables.push_back({ Texture(), kind, sampler });
    glBindTexture(kind, tables.back().texture.name());
    const GLint filter = interpolation == ocio::INTERP_NEAREST ? GL_NEAREST : GL_LINEAR;
    glTexParameteri(kind, GL_TEXTURE_MIN_FILTER, filter);
    glTexParameteri(kind, GL_TEXTURE_MAG_FILTER, filter);
    for (const int side : { GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T, GL_TEXTURE_WRAP_R })
        glTexParameteri(kind, GLenum(side), GL_CLAMP_TO_EDGE);
}

void ColourShader::Tables::add_cube(const ocio::GpuShaderDesc& shader, unsigned index)
{
    const char *texture = nullptr, *sampler = nullptr;
    unsigned edge = 0;
    ocio::Interpolation interpolation = ocio::INTERP_LINEAR;
    const float* values = nullptr;
    shader.get3DTexture(index, texture, sampler, edge, interpolation);
    shader.get3DTextureValues(index, values);
    begin(GL_TEXTURE_3D, sampler, interpolation);
    const auto side = GLsizei(edge);
    glTexImage3D(GL_TEXTURE_3D, 0, GL_RGB32F, side, side, side, 0, GL_RGB, GL_FLOAT, values);
}

void ColourShader::Tables::add_curve(const ocio::GpuShaderDesc& shader, unsigned index)
{
    const char *texture = nullptr, *sampler = nullptr;
    unsigned width = 0, height = 0;
    ocio::GpuShaderDesc::TextureType channel = ocio::GpuShaderDesc::TEXTURE_RGB_CHANNEL;
    ocio::Interpolation interpolation = ocio::INTERP_LINEAR;
    const float* values = nullptr;
#if OCIO_VERSION_HEX >= 0x02030000  // where a curve of one row may be a texture of two dimensions
    ocio::GpuShaderDesc::TextureDimensions dimensions = ocio::GpuShaderDesc::TEXTURE_1D;
    shader.getTexture(index, texture, sampler, width, height, channel, dimensions, interpolation);
    const bool is_plane = dimensions == ocio::GpuShaderDesc::TEXTURE_2D;
#else
    shader.getTexture(index, texture, sampler, width, height, channel, interpolation);
    const bool is_plane = height > 1;
#endif
    shader.getTextureValues(index, values);
    const bool red = channel == ocio::GpuShaderDesc::TEXTURE_RED_CHANNEL;
    const GLenum numbers = red ? GL_RED : GL_RGB;
    const GLint stored = red ? GL_R32F : GL_RGB32F;
    if (is_plane) {
        begin(GL_TEXTURE_2D, sampler, interpolation);
        glTexImage2D(GL_TEXTURE_2D, 0, stored, GLsizei(width), GLsizei(height), 0, numbers, GL_FLOAT, values);
    } else {
        begin(GL_TEXTURE_1D, sampler, interpolation);
        glTexImage1D(GL_TEXTURE_1D, 0, stored, GLsizei(width), 0, numbers, GL_FLOAT, values);
    }
}

void ColourShader::Tables::add(const ocio::GpuShaderDesc& shader)
{
    for (unsigned i = 0; i < shader.getNum3DTextures(); ++i)
        add_cube(shader, i);
    for (unsigned i = 0; i < shader.getNumTextures(); ++i)
        add_curve(shader, i);
}

ColourShader::ColourShader() = default;

ColourShader::~ColourShader()
{
    glDeleteProgram(m_program);
}

bool ColourShader::use(const Light& result, const Light& source, const LookOptions& look, std::string& error)
{
    const bool same = m_program != 0 && m_result == result && m_source == source && m_display == look.display
        && m_transform == look.transform && m_definitions == definitions(look);
    if (!same) {
        m_definitions = definitions(look);
        m_result = result;
        m_source = source;
        m_display = look.display;
        m_transform = look.transform;
        glDeleteProgram(m_program);
        m_program = 0;
        try {
            if (!build(error))
                return false;
        } catch (const ocio::Exception& exception) {
            error = format("display \"{}\": {}", look.display, exception.what());
            return false;
        }
    }
    glUseProgram(m_program);
    for (std::size_t i = 0; i < m_tables->tables.size(); ++i) {
        glActiveTexture(GLenum(GL_TEXTURE2 + i));
        glBindTexture(m_tables->tables[i].kind, m_tables->tables[i].texture.name());
    }
    return true;
}

bool ColourShader::build(std::string& error)
{
    const ocio::ConstConfigRcPtr config = current_config();
    const bool managed = !m_display.empty();
    const std::pair<const char*, ocio::ConstProcessorRcPtr> processors[] = {
        { "result_to_linear", to_linear(config, m_result, managed) },
        { "source_to_linear", to_linear(config, m_source, managed) },
        { "to_display", to_display(config, m_display, m_transform) },
    };
    m_tables = std::make_unique<Tables>();
    std::string text = "#version 150\n";
    for (const auto& [name, processor] : processors) {
        ocio::GpuShaderDescRcPtr shader = ocio::GpuShaderDesc::CreateShaderDesc();
        shader->setLanguage(ocio::GPU_LANGUAGE_GLSL_1_3);
        shader->setFunctionName(name);
        shader->setResourcePrefix((std::string(name) + "_").c_str());
        processor->getDefaultGPUProcessor()->extractGpuShaderInfo(shader);
        text += shader->getShaderText();
        m_tables->add(*shader);
    }
    m_program = make_program(kVertex, text + m_definitions + kMain, error);
    if (m_program == 0)
        return false;
    glUseProgram(m_program);
    for (std::size_t i = 0; i < m_tables->tables.size(); ++i)
        glUniform1i(glGetUniformLocation(m_program, m_tables->tables[i].sampler.c_str()), GLint(2 + i));
    return true;
}

void ColourShader::set(const LookOptions& look, float split_x)
{
    const auto at = [this](const char* name) {
        return glGetUniformLocation(m_program, name);
    };
    glUniform1i(at("result"), 0);
    glUniform1i(at("source"), 1);
    glUniform1f(at("gain"), std::exp2(look.exposure));
    glUniform1f(at("inverse_gamma"), 1.0f / look.gamma);
    glUniform1f(at("boost"), look.boost);
    glUniform1f(at("split_x"), split_x);
}

}  // namespace pimgview
