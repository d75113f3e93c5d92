// SPDX-License-Identifier: BSD-3-Clause
// The shader that shows pictures: OpenColorIO's GPU processors between numbers, linear light and the display.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "gl/gl.h"
#include "render/frame.h"
#include "state/look.h"

namespace pimgview {

/// Displays of the configuration $OCIO names and the views of each; none without one.
struct DisplayList {
    std::vector<std::string> displays;
    std::vector<std::vector<std::string>> views;
};
DisplayList display_list();

class ColourShader {
public:
    ColourShader();
    ~ColourShader();
    ColourShader(const ColourShader&) = delete;
    ColourShader& operator=(const ColourShader&) = delete;

    /// Makes the shader program for pictures with these meanings of their numbers, unless it is the present program,
    /// and selects it for drawing. Textures 0 and 1 are result and source. False, with one line in `error`, if there is
    /// no such display or the driver refuses the program.
    bool use(const Light& result, const Light& source, const LookOptions& look, std::string& error);

    /// What changes from draw to draw. `split_x` is in pixels of the frame buffer.
    void set(const LookOptions& look, float split_x);

private:
    struct Tables;

    bool build(std::string& error);

    GLuint m_program = 0;
    Light m_result, m_source;
    std::string m_display, m_transform, m_definitions;
    std::unique_ptr<Tables> m_tables;
};

}  // namespace pimgview
