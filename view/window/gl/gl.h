// SPDX-License-Identifier: BSD-3-Clause
// OpenGL 3.2 as the system's library declares it, and owners of what it hands out.
#pragma once

#ifndef GL_GLEXT_PROTOTYPES
#define GL_GLEXT_PROTOTYPES
#endif
#define GLFW_INCLUDE_GLCOREARB
#include <GLFW/glfw3.h>

#include <string>
#include <utility>

namespace pimgview {

/// A texture that goes with its owner.
class Texture {
public:
    Texture() { glGenTextures(1, &m_name); }
    ~Texture() { glDeleteTextures(1, &m_name); }
    Texture(Texture&& other) noexcept : m_name(std::exchange(other.m_name, 0)) { }
    Texture& operator=(Texture&& other) noexcept
    {
        std::swap(m_name, other.m_name);
        return *this;
    }
    GLuint name() const { return m_name; }

private:
    GLuint m_name = 0;
};

/// Compiles and links; 0, with the driver's words in `error`, if it does not want to.
GLuint make_program(const std::string& vertex, const std::string& fragment, std::string& error);

}  // namespace pimgview
