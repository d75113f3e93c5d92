// SPDX-License-Identifier: BSD-3-Clause
#include "window.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_opengl3.h>
#include <imgui.h>

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/imagebufalgo.h>

#include <pimg/detail/format.h>

#include "process_time.h"
#include "session/output.h"

namespace pimgview {

namespace {

using pimg::format;

std::string glfw_error()
{
    const char* words = nullptr;
    glfwGetError(&words);
    return words != nullptr ? words : "no reason given";
}

/// Whether textures of 32-bit floats can be made and filtered.
bool has_float_textures()
{
    const Texture texture;
    glBindTexture(GL_TEXTURE_2D, texture.name());
    while (glGetError() != GL_NO_ERROR) { }
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGB32F, 16, 16, 0, GL_RGB, GL_FLOAT, nullptr);
    GLint bits = 0;
    glGetTexLevelParameteriv(GL_TEXTURE_2D, 0, GL_TEXTURE_RED_SIZE, &bits);
    return glGetError() == GL_NO_ERROR && bits == 32;
}

}  // namespace

Window::Window(const Arguments& arguments) : m_arguments(arguments), m_random(std::uint32_t(arguments.seed)) { }

Window::~Window()
{
    m_bench.reset();  // first: its threads post events
    m_view.reset();
    if (m_imgui) {
        ImGui_ImplOpenGL3_Shutdown();
        ImGui_ImplGlfw_Shutdown();
        ImGui::DestroyContext();
    }
    if (m_window != nullptr)
        glfwDestroyWindow(m_window);
    if (m_glfw)
        glfwTerminate();
}

/// Where the window was when the program last ended, unless the command line says its size. False if it is not known, or is
/// on no monitor any more.
bool Window::find_place(int& left, int& top)
{
    int width = 0, height = 0, count = 0;
    const auto found = m_bench->settings.find("window");
    if (m_arguments.sized || found == m_bench->settings.end()
        || std::sscanf(found->second.c_str(), "%dx%d%d%d", &width, &height, &left, &top) != 4 || width < 64
        || height < 64 || width > 16384 || height > 16384)
        return false;
    m_arguments.width = width;
    m_arguments.height = height;
    GLFWmonitor** const monitors = glfwGetMonitors(&count);
    for (int i = 0; i < count; ++i) {
        int x = 0, y = 0, w = 0, h = 0;
        glfwGetMonitorWorkarea(monitors[i], &x, &y, &w, &h);
        if (left + width / 2 >= x && left + width / 2 < x + w && top >= y && top < y + h)
            return true;
    }
    return false;
}

void Window::remember_place()
{
    int width = 0, height = 0, left = 0, top = 0;
    glfwGetWindowSize(m_window, &width, &height);
    glfwGetWindowPos(m_window, &left, &top);
    if (glfwGetWindowAttrib(m_window, GLFW_ICONIFIED) == GLFW_FALSE)
        m_bench->settings["window"] = format("{}x{}{:+d}{:+d}", width, height, left, top);
}

bool Window::open(std::string& error)
{
    // First, so that the file is read while the driver makes a window.
    m_bench = std::make_unique<Workbench>(m_arguments, [this] {
        if (m_glfw)
            glfwPostEmptyEvent();
    });
    if (!glfwInit()) {
        error = format("no display: {}", glfw_error());
        return false;
    }
    m_glfw = true;
    glfwSetTime(seconds_since_start());
    glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 3);
    glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 2);
    glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
    glfwWindowHint(GLFW_SCALE_TO_MONITOR, m_arguments.sized ? GLFW_FALSE : GLFW_TRUE);
    int left = 0, top = 0;
    const bool placed = find_place(left, top);
    m_window = glfwCreateWindow(m_arguments.width, m_arguments.height, "pimgview", nullptr, nullptr);
    if (m_window == nullptr) {
        error = format("no window with OpenGL 3.2: {}", glfw_error());
        return false;
    }
    if (placed)
        glfwSetWindowPos(m_window, left, top);
    glfwMakeContextCurrent(m_window);
    const bool timed =
        !m_arguments.measured.empty() || !m_arguments.screenshot.empty() || m_arguments.random_events > 0;
    glfwSwapInterval(timed ? 0 : 1);
    if (!has_float_textures()) {
        error = format("the graphics driver has no textures of 32-bit floats: {}",
                       reinterpret_cast<const char*>(glGetString(GL_RENDERER)));
        return false;
    }
    glfwSetWindowUserPointer(m_window, this);
    glfwSetDropCallback(m_window, on_drop);
    begin_panels();
    m_view = std::make_unique<PictureView>(m_arguments.tile);
    return true;
}

void Window::on_drop(GLFWwindow* window, int count, const char** names)
{
    auto* self = static_cast<Window*>(glfwGetWindowUserPointer(window));
    self->m_dropped.assign(names, names + count);
}

/// Dear ImGui, with letters of the size that the screen asks for.
void Window::begin_panels()
{
    ImGui::CreateContext();
    m_imgui = true;
    ImGuiIO& io = ImGui::GetIO();
    io.IniFilename = nullptr;
    float horizontal = 1.0f;
    glfwGetWindowContentScale(m_window, &horizontal, &m_scale);
    ImFontConfig font;
    font.SizePixels = std::round(13.0f * m_scale);  // the built-in font is drawn for 13 pixels
    io.Fonts->AddFontDefault(&font);
    ImGui::GetStyle().ScaleAllSizes(m_scale);
    ImGui_ImplGlfw_InitForOpenGL(m_window, true);
    glfwSetKeyCallback(m_window, on_key);
    ImGui_ImplOpenGL3_Init("#version 150");
}

/// Keys wait here for the next frame. Dear ImGui only knows which are down, and would miss those that are up again by then,
/// such as the Enter that ends typing: it is told of that after the frame.
void Window::on_key(GLFWwindow* window, int code, int scan, int action, int modifiers)
{
    auto* self = static_cast<Window*>(glfwGetWindowUserPointer(window));
    const int place = code;
    const bool unseen = std::any_of(self->m_pressed.begin(), self->m_pressed.end(),
                                    [place](const Pressed& pressed) { return pressed.place == place; });
    if (action == GLFW_RELEASE && unseen) {
        self->m_released.push_back(place);
        return;
    }
    ImGui_ImplGlfw_KeyCallback(window, code, scan, action, modifiers);
    if (action == GLFW_RELEASE)
        return;
    // GLFW numbers keys by their place on a US keyboard; what counts is what is printed on them.
    const char* name = code >= GLFW_KEY_A && code <= GLFW_KEY_Z ? glfwGetKeyName(code, scan) : nullptr;
    if (name != nullptr && name[0] >= 'a' && name[0] <= 'z' && name[1] == '\0')
        code = name[0] - 'a' + GLFW_KEY_A;
    self->m_pressed.push_back({ code, (modifiers & GLFW_MOD_CONTROL) != 0, (modifiers & GLFW_MOD_SHIFT) != 0, place });
}

Viewport Window::area() const
{
    int width = 1, height = 1;
    glfwGetFramebufferSize(m_window, &width, &height);
    Viewport area;
    const bool panels = m_bench->look.panels;
    area.x = panels ? std::min(width - 1, int(Panels::kWidth * m_scale)) : 0;
    area.width = std::max(1, width - area.x);
    area.height = std::max(1, panels ? height - int(Panels::kStatusHeight * m_scale) : height);
    const DocumentState document = m_bench->studio.document().state();
    const std::shared_ptr<const Shown> shown = m_bench->studio.shown();
    if (!document.has_picture() && shown) {
        area.picture_width = shown->width;
        area.picture_height = shown->height;
    } else if (document.has_picture()) {
        area.picture_width = document.width;
        area.picture_height = document.height;
    }
    return area;
}

void Window::keys()
{
    const std::vector<Pressed> pressed_keys = std::exchange(m_pressed, {});
    for (const int place : std::exchange(m_released, {}))
        ImGui_ImplGlfw_KeyCallback(m_window, place, 0, GLFW_RELEASE, 0);
    if (ImGui::GetIO().WantTextInput)
        return;
    for (const Pressed& pressed : pressed_keys)
        for (const Key& key : key_table())
            if (key.code == pressed.code && key.control == pressed.control && key.shift == pressed.shift) {
                m_bench->act(key.action);
                m_view->act(*m_bench, key.action);
            }
}

void Window::drop_in()
{
    if (m_dropped.empty())
        return;
    m_bench->open(m_dropped);
    m_dropped.clear();
}

/// The command line is the title, so that it is seen without panels, too.
void Window::show_title()
{
    const std::string line = m_bench->index >= 0 ? m_bench->line() + " - pimgview" : "pimgview";
    if (line != m_title)
        glfwSetWindowTitle(m_window, line.c_str());
    m_title = line;
}

void Window::draw_frame()
{
    ImGui_ImplOpenGL3_NewFrame();
    ImGui_ImplGlfw_NewFrame();
    if (m_arguments.random_events > 0)
        inject_random_events();
    ImGui::NewFrame();
    drop_in();
    keys();
    if (m_bench->look.light)
        ImGui::StyleColorsLight();
    else
        ImGui::StyleColorsDark();
    int width = 1, height = 1, points = 1, rows = 1;
    glfwGetFramebufferSize(m_window, &width, &height);
    glfwGetWindowSize(m_window, &points, &rows);
    const Viewport view = area();
    m_view->interact(*m_bench, view, double(width) / std::max(1, points));
    m_view->draw_overlays(*m_bench, double(width) / std::max(1, points));
    m_panels.draw(*m_bench, m_view->info(), m_scale);
    const bool held = ImGui::IsAnyItemActive() || m_drag_begun > 0.0;
    m_bench->update(view.visible(m_bench->look), 1.0 / view.zoom(m_bench->look), held);
    if (!held && !m_view->dragging())
        m_bench->record();
    show_title();
    ImGui::Render();
    glViewport(0, 0, width, height);
    const float grey = m_bench->look.light ? 0.6f : 0.1f;
    glClearColor(grey, grey, grey, 1.0f);
    glClear(GL_COLOR_BUFFER_BIT);
    m_view->draw(*m_bench, width, height);
    ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
}

bool Window::finished(std::string& error, bool& failed)
{
    const DocumentState document = m_bench->studio.document().state();
    if (m_first_picture == 0.0 && m_view->pictures() > 0)
        m_first_picture = glfwGetTime();
    if (m_first_sliders == 0.0 && document.first_build_seconds > 0.0)
        m_first_sliders = glfwGetTime();
    if (m_drag_begun > 0.0)
        return measure();
    const bool settled = m_bench->studio.settled() && m_view->is_current(*m_bench);
    m_settled_frames = settled ? m_settled_frames + 1 : 0;
    constexpr int kFramesToSettle = 3;  // panels find their sizes in the second frame
    if (m_settled_frames < kFramesToSettle)
        return m_arguments.random_events > 0 && m_events >= m_arguments.random_events;
    if (m_whole == 0.0)
        m_whole = glfwGetTime();
    if (!m_arguments.measured.empty())
        return measure();
    if (m_arguments.random_events > 0)
        return m_events >= m_arguments.random_events;
    if (!m_bench->save_name.empty() && !m_arguments.script.output.empty()) {
        m_arguments.script.output.clear();
        m_bench->studio.save(m_bench->stack, m_bench->save_name);
        m_settled_frames = 0;
        return false;
    }
    if (m_arguments.screenshot.empty())
        return false;
    const SaveState saving = m_bench->studio.saving();
    for (const std::string& problem : { document.error, m_bench->studio.error(), saving.failed ? saving.text : "" })
        if (!problem.empty())
            error = problem;
    failed = !write_screenshot(error) || !error.empty();
    if (failed || m_arguments.more.empty())
        return true;
    begin_next_shot();
    return false;
}

void Window::begin_next_shot()
{
    const Shot next = m_arguments.more.front();
    m_arguments.more.erase(m_arguments.more.begin());
    m_arguments.script = next.script;
    m_arguments.screenshot = next.screenshot;
    m_bench->replace(next.script);
    m_settled_frames = 0;
}

/// Lets the first frame have a picture if that is about to be read: two first frames take twice as long.
void Window::await_picture()
{
    constexpr double kMost = 0.1, kLook = 0.005;
    const auto is_coming = [this] {
        return !m_arguments.files.empty() && !m_bench->studio.shown()
            && m_bench->studio.document().state().error.empty();
    };
    for (const double end = glfwGetTime() + kMost; is_coming() && glfwGetTime() < end;) {
        const Viewport view = area();
        m_bench->update(view.visible(m_bench->look), 1.0 / view.zoom(m_bench->look), false);
        glfwWaitEventsTimeout(kLook);
    }
}

/// Until there is something to draw, but no shorter than a frame of the screen: more frames than it shows would take
/// the processor from the filters.
void Window::wait()
{
    constexpr double kFrame = 1.0 / 60.0, kIdle = 0.1;
    const double next = m_drawn_at + kFrame;
    if (m_arguments.random_events > 0 || (m_settled_frames > 0 && !m_arguments.screenshot.empty()))
        glfwPollEvents();
    else
        glfwWaitEventsTimeout(m_drag_begun > 0.0 || m_bench->playing ? kFrame : kIdle);
    while (m_arguments.random_events == 0 && m_view->is_current(*m_bench) && glfwGetTime() < next)
        glfwWaitEventsTimeout(std::max(1e-4, next - glfwGetTime()));
    m_drawn_at = glfwGetTime();
}

bool Window::run(std::string& error)
{
    bool failed = false;
    await_picture();
    while (!glfwWindowShouldClose(m_window) && !m_bench->quit) {
        wait();
        draw_frame();
        if (finished(error, failed))
            break;
        glfwSwapBuffers(m_window);
    }
    const bool ends = m_arguments.screenshot.empty() && m_arguments.measured.empty() && m_arguments.random_events == 0;
    if (ends) {
        remember_place();
        m_bench->remember();
    }
    glfwHideWindow(m_window);
    if (!m_bench->studio.stop()) {
        // The user must not have to wait for a filter or a reader to end, whose result would be lost anyway.
        std::fflush(nullptr);
        std::_Exit(failed ? 1 : 0);
    }
    return !failed;
}

bool Window::write_screenshot(std::string& error) const
{
    int width = 1, height = 1;
    glfwGetFramebufferSize(m_window, &width, &height);
    std::vector<unsigned char> pixels(std::size_t(width) * std::size_t(height) * 3);
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    glReadPixels(0, 0, width, height, GL_RGB, GL_UNSIGNED_BYTE, pixels.data());
    OIIO::ImageBuf image(OIIO::ImageSpec(width, height, 3, OIIO::TypeUInt8));
    image.specmod().attribute("oiio:ColorSpace", "sRGB");
    for (int y = 0; y < height; ++y)
        image.set_pixels(OIIO::ROI(0, width, y, y + 1), OIIO::TypeUInt8,
                         &pixels[std::size_t(height - 1 - y) * std::size_t(width) * 3]);
    std::string summary, warning, problem;
    const pimgtool::OutputPicture out { image, { OIIO::TypeUInt8, {} }, false, false };
    if (pimgtool::can_write(m_arguments.screenshot, problem)
        && pimgtool::write_picture(out, m_arguments.screenshot, [](float) {}, { summary, warning, problem }))
        return true;
    error = format("cannot write \"{}\": {}", m_arguments.screenshot, problem);
    return false;
}

bool Window::measure()
{
    constexpr double kSeconds = 5.0;  // hundreds of frames
    const double now = glfwGetTime();
    for (StackItem& item : m_bench->stack.items)
        for (const pimg::OptionInfo& option : item.filter->options()) {
            if (option.key != m_arguments.measured)
                continue;
            const SliderRange range = slider_range(option);
            const double share = 0.5 + 0.45 * std::sin(now);
            const double value = range.low + (std::min(range.high, 100.0) - range.low) * share;
            set_value(item, option, format("{:.4f}", value));
        }
    if (m_drag_begun == 0.0) {
        m_drag_begun = now;
        m_drag_last = m_view->pictures();
        return false;
    }
    if (m_view->pictures() != m_drag_last && m_view->drawn() != nullptr) {
        m_drag_pictures += m_view->pictures() - m_drag_last;
        m_drag_last = m_view->pictures();
        m_filter_seconds += m_view->drawn()->result.seconds;
        m_make_seconds += m_view->drawn()->seconds;
    }
    if (now - m_drag_begun < kSeconds)
        return false;
    print_measurement();
    return true;
}

void Window::print_measurement() const
{
    const double seconds = glfwGetTime() - m_drag_begun;
    const DocumentState document = m_bench->studio.document().state();
    const double each = m_drag_pictures > 0 ? 1000.0 / m_drag_pictures : 0.0;
    std::printf("%s\n", reinterpret_cast<const char*>(glGetString(GL_RENDERER)));
    std::printf("first picture %.2f s, sliders that answer %.2f s, all built %.2f s after the start\n", m_first_picture,
                m_first_sliders, m_whole);
    std::printf(
        "dragging %s: %.1f pictures per second; %.1f ms each, of which filters %.1f ms, preparing textures %.1f ms\n",
        m_arguments.measured.c_str(), m_drag_pictures / seconds, seconds * each, m_filter_seconds * each,
        (m_make_seconds - m_filter_seconds) * each);
    std::printf("memory %.0f MB\n", double(m_bench->studio.memory() + m_view->info().texture_memory) / 1e6);
}

/// Random keys (but none that end the program or write files), clicks, drags and turns of the wheel, anywhere.
void Window::inject_random_events()
{
    ImGuiIO& io = ImGui::GetIO();
    ++m_events;
    const auto random = [this](int count) {
        return int(m_random() % std::uint32_t(count));
    };
    std::fill(std::begin(io.KeysDown), std::end(io.KeysDown), false);
    io.KeyCtrl = io.KeyShift = false;
    switch (random(6)) {
    case 0: {
        const Key& key = key_table()[std::size_t(random(int(key_table().size())))];
        if (key.action != Action::quit && key.action != Action::save && key.action != Action::copy) {
            io.KeysDown[key.code] = true;
            io.KeyCtrl = key.control;
            io.KeyShift = key.shift;
            m_pressed.push_back({ key.code, key.control, key.shift, key.code });
        }
        break;
    }
    case 1:
        io.MouseWheel = float(random(5) - 2);
        break;
    case 2:
        m_mouse_down = !m_mouse_down;
        break;
    case 3:
        io.AddInputCharacter(unsigned('0' + random(10)));
        break;
    default:
        m_mouse_x = float(random(int(io.DisplaySize.x)));
        m_mouse_y = float(random(int(io.DisplaySize.y)));
        break;
    }
    io.MousePos = { m_mouse_x, m_mouse_y };
    io.MouseDown[0] = m_mouse_down;
}

}  // namespace pimgview
