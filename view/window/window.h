// SPDX-License-Identifier: BSD-3-Clause
// The window, and the loop that draws it.
#pragma once

#include <atomic>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "picture_view.h"

struct GLFWwindow;

namespace pimgview {

class Window {
public:
    explicit Window(const Arguments& arguments);
    ~Window();
    Window(const Window&) = delete;
    Window& operator=(const Window&) = delete;

    /// Opens the window. False with one line in `error` that says what is missing.
    bool open(std::string& error);

    /// Draws until the user quits, or the screenshot, the measurement or the random events are done.
    bool run(std::string& error);

private:
    void begin_panels();
    bool find_place(int& left, int& top);
    void remember_place();
    void await_picture();
    void wait();
    void show_title();
    void draw_frame();
    void keys();
    void drop_in();
    void inject_random_events();
    bool measure();
    void print_measurement() const;
    bool write_screenshot(std::string& error) const;
    void begin_next_shot();
    bool finished(std::string& error, bool& failed);
    Viewport area() const;

    struct Pressed {
        int code;
        bool control, shift;
        int place;  ///< on a US keyboard, as GLFW numbers keys
    };

    static void on_key(GLFWwindow* window, int code, int scan, int action, int modifiers);
    static void on_drop(GLFWwindow* window, int count, const char** names);

    Arguments m_arguments;
    GLFWwindow* m_window = nullptr;
    std::atomic<bool> m_glfw { false };  ///< GLFW is ready; threads ask
    bool m_imgui = false;
    std::unique_ptr<Workbench> m_bench;
    std::unique_ptr<PictureView> m_view;
    Panels m_panels;
    float m_scale = 1.0f;  ///< of the screen
    std::string m_title;
    std::vector<std::string> m_dropped;
    std::vector<Pressed> m_pressed;  ///< since the last frame
    std::vector<int> m_released;     ///< of these, which Dear ImGui has not been told of

    int m_settled_frames = 0;
    double m_drawn_at = 0.0;
    double m_first_picture = 0.0, m_first_sliders = 0.0, m_whole = 0.0;

    std::mt19937 m_random;
    int m_events = 0;
    float m_mouse_x = 0.0f, m_mouse_y = 0.0f;
    bool m_mouse_down = false;

    double m_drag_begun = 0.0, m_filter_seconds = 0.0, m_make_seconds = 0.0;
    int m_drag_pictures = 0, m_drag_last = 0;
};

}  // namespace pimgview
