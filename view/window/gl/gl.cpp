// SPDX-License-Identifier: BSD-3-Clause
#include "gl/gl.h"

#include <vector>

namespace pimgview {

namespace {

GLuint compile(GLenum kind, const std::string& text, std::string& error)
{
    const GLuint shader = glCreateShader(kind);
    const char* source = text.c_str();
    glShaderSource(shader, 1, &source, nullptr);
    glCompileShader(shader);
    GLint fine = GL_FALSE, length = 0;
    glGetShaderiv(shader, GL_COMPILE_STATUS, &fine);
    if (fine == GL_TRUE)
        return shader;
    glGetShaderiv(shader, GL_INFO_LOG_LENGTH, &length);
    error.resize(std::size_t(length));
    glGetShaderInfoLog(shader, length, nullptr, error.data());
    glDeleteShader(shader);
    return 0;
}

}  // namespace

GLuint make_program(const std::string& vertex, const std::string& fragment, std::string& error)
{
    const GLuint shaders[2] = { compile(GL_VERTEX_SHADER, vertex, error),
                                compile(GL_FRAGMENT_SHADER, fragment, error) };
    GLuint program = 0;
    if (shaders[0] != 0 && shaders[1] != 0) {
        program = glCreateProgram();
        glAttachShader(program, shaders[0]);
        glAttachShader(program, shaders[1]);
        glBindAttribLocation(program, 0, "corner");
        glLinkProgram(program);
        GLint fine = GL_FALSE;
        glGetProgramiv(program, GL_LINK_STATUS, &fine);
        if (fine != GL_TRUE) {
            char log[1024] = "";
            glGetProgramInfoLog(program, sizeof log, nullptr, log);
            error = log;
            glDeleteProgram(program);
            program = 0;
        }
    }
    for (const GLuint shader : shaders)
        glDeleteShader(shader);
    return program;
}

}  // namespace pimgview
