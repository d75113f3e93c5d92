// SPDX-License-Identifier: BSD-3-Clause
#include "picture_view.h"

#include <algorithm>
#include <cmath>

#include <imgui.h>

#include <pimg/detail/format.h>

namespace pimgview {

void PictureView::interact(Workbench& bench, const Viewport& area, double pixel_scale)
{
    m_area = area;
    const ImGuiIO& io = ImGui::GetIO();
    const double x = double(io.MousePos.x) * pixel_scale, y = double(io.MousePos.y) * pixel_scale;
    const bool over = !io.WantCaptureMouse && area.contains(x, y);
    if (over && io.MouseWheel != 0.0f) {
        constexpr double kNotch = 1.25;  // three notches double the size
        area.zoom_about(bench.look, std::pow(kNotch, double(io.MouseWheel)), x, y);
    }
    constexpr double kNear = 8.0;  // screen pixels from which the split line is taken
    const double line = area.x + double(bench.look.split) * area.width;
    if (over && ImGui::IsMouseClicked(ImGuiMouseButton_Left)) {
        m_splitting = bench.look.show == "split" && std::fabs(x - line) < kNear * pixel_scale;
        m_panning = !m_splitting;
    }
    if (!ImGui::IsMouseDown(ImGuiMouseButton_Left))
        m_panning = m_splitting = false;
    if (m_splitting)
        bench.look.split = float(std::clamp((x - area.x) / area.width, 0.0, 1.0));
    const bool moved = io.MouseDelta.x != 0.0f || io.MouseDelta.y != 0.0f;
    if (m_panning && moved)
        area.pan(bench.look, double(io.MouseDelta.x) * pixel_scale, double(io.MouseDelta.y) * pixel_scale);
    m_info.zoom = area.zoom(bench.look);
    m_info.has_pixel = false;
    if (over)
        look_up_pixel(bench, x, y);
}

void PictureView::look_up_pixel(const Workbench& bench, double at_x, double at_y)
{
    const std::shared_ptr<const Shown> shown = bench.studio.shown();
    if (!shown || shown->document != bench.studio.document().state().version)
        return;
    m_info.x = int(std::floor((at_x - m_area.left(bench.look)) / m_info.zoom));
    m_info.y = int(std::floor((at_y - m_area.top(bench.look)) / m_info.zoom));
    m_info.has_pixel = pixel_at(shown->source, m_info.x, m_info.y, m_info.source)
        && pixel_at(shown->result, m_info.x, m_info.y, m_info.result);
}

void PictureView::draw_words(const std::string& words, double pixel_scale) const
{
    constexpr float kShare = 0.8f;  // of the width that the words may take
    const float width = float(m_area.width / pixel_scale), height = float(m_area.height / pixel_scale);
    const ImVec2 size = ImGui::CalcTextSize(words.c_str(), nullptr, false, kShare * width);
    const ImVec2 corner { float(m_area.x / pixel_scale) + (width - size.x) / 2,
                          float(m_area.y / pixel_scale) + (height - size.y) / 2 };
    ImGui::GetBackgroundDrawList()->AddText(nullptr, 0.0f, corner, ImGui::GetColorU32(ImGuiCol_Text), words.c_str(),
                                            nullptr, kShare * width);
}

void PictureView::draw_overlays(const Workbench& bench, double pixel_scale)
{
    const std::shared_ptr<const Shown> shown = bench.studio.shown();
    const DocumentState document = bench.studio.document().state();
    if (bench.index < 0)
        draw_words("Drop pictures here, or open them with Ctrl+O. F1 lists the keys.", pixel_scale);
    else if (!document.has_picture())
        draw_words(document.error, pixel_scale);
    if (!shown || shown->document != document.version)
        return;
    ImDrawList* draw = ImGui::GetBackgroundDrawList();
    const double left = m_area.left(bench.look), top = m_area.top(bench.look), zoom = m_area.zoom(bench.look);
    const auto place = [&](float x, float y) {
        return ImVec2(float((left + double(x) * zoom) / pixel_scale), float((top + double(y) * zoom) / pixel_scale));
    };
    draw->PushClipRect(
        { float(m_area.x / pixel_scale), float(m_area.y / pixel_scale) },
        { float((m_area.x + m_area.width) / pixel_scale), float((m_area.y + m_area.height) / pixel_scale) });
    if (shown->mesh)
        for (const Line& line : shown->mesh->lines)
            draw->AddLine(place(line.x0, line.y0), place(line.x1, line.y1), IM_COL32(255, 200, 0, 160));
    if (shown->mesh && shown->mesh->too_many)
        draw->AddText(place(0, 0), IM_COL32(255, 200, 0, 255), "too many edges in view: zoom in, or fewer vertices");
    Piece piece;
    if (shown->pieces && m_info.has_pixel && piece_at(*shown->pieces, m_info.x, m_info.y, piece)) {
        for (const Line& line : piece.outline)
            draw->AddLine(place(line.x0, line.y0), place(line.x1, line.y1), IM_COL32(0, 255, 255, 255), 2.0f);
        std::string text = pimg::format("piece of {} pixels", piece.pixels);
        for (const std::string& line : piece.history)
            text += "\n" + line;
        ImGui::SetTooltip("%s", text.c_str());
    }
    draw->PopClipRect();
}

void PictureView::act(Workbench& bench, Action action) const
{
    constexpr double kStep = 1.25;  // as a notch of the wheel
    const double x = m_area.x + m_area.width / 2.0, y = m_area.y + m_area.height / 2.0;
    if (action == Action::fit)
        bench.look.zoom = 0.0f;
    if (action == Action::actual_size)
        m_area.zoom_about(bench.look, 1.0 / m_area.zoom(bench.look), x, y);
    if (action == Action::zoom_in)
        m_area.zoom_about(bench.look, kStep, x, y);
    if (action == Action::zoom_out)
        m_area.zoom_about(bench.look, 1.0 / kStep, x, y);
}

/// Whether a picture is that of the file; or of the one before, while this one is being read.
bool PictureView::may_draw(const DocumentState& document, const Shown& shown) const
{
    const bool same_size = shown.width == m_area.picture_width && shown.height == m_area.picture_height;
    return shown.document == document.version || (same_size && document.error.empty());
}

void PictureView::draw(Workbench& bench, int buffer_width, int buffer_height)
{
    const std::shared_ptr<const Shown> shown = bench.studio.shown();
    if (!shown || !may_draw(bench.studio.document().state(), *shown))
        return;
    if (shown != m_drawn) {
        m_texture.upload(*shown->frame, shown->source_frame.get());
        m_drawn = shown;
        ++m_pictures;
    }
    m_info.texture_memory = m_texture.memory() + m_canvas.memory();
    const Painted wanted { shown,        bench.look,    m_area.x,     m_area.y,
                           m_area.width, m_area.height, buffer_width, buffer_height };
    if (!(wanted == m_painted)) {
        m_painted = {};
        const bool kept = m_canvas.begin(buffer_width, buffer_height);
        glClear(GL_COLOR_BUFFER_BIT);
        const bool painted = paint(bench, *shown, buffer_width, buffer_height);
        if (!kept)
            return;
        Canvas::end();
        if (!painted)
            return;
        m_painted = wanted;
    }
    m_canvas.show(m_area.x, buffer_height - m_area.y - m_area.height, m_area.width, m_area.height);
}

bool PictureView::paint(Workbench& bench, const Shown& shown, int buffer_width, int buffer_height)
{
    const Light source = shown.source_frame ? shown.source_frame->light : shown.frame->light;
    LookOptions look = bench.look;
    if (!shown.source_frame)
        look.show = "result";  // for the frame until there is one
    std::string error;
    if (!m_shader.use(shown.frame->light, source, look, error)) {
        bench.message = error;
        bench.look.display.clear();
        bench.look.transform.clear();
        return false;
    }
    m_shader.set(look, float(m_area.x + double(look.split) * m_area.width));
    const double zoom = m_area.zoom(look);
    const Placement placement { m_area.left(look), m_area.top(look), zoom, buffer_width, buffer_height };
    const Region& region = shown.frame->region;
    // Texels at the right and lower edges may reach beyond the picture.
    const int right = std::min(m_area.x + m_area.width, int(std::ceil(placement.left + m_area.picture_width * zoom)));
    const int bottom = std::min(m_area.y + m_area.height, int(std::ceil(placement.top + m_area.picture_height * zoom)));
    const int left = std::max(m_area.x, int(std::floor(placement.left + region.x0 * zoom)));
    const int top = std::max(m_area.y, int(std::floor(placement.top + region.y0 * zoom)));
    glEnable(GL_SCISSOR_TEST);
    glScissor(left, buffer_height - bottom, std::max(0, right - left), std::max(0, bottom - top));
    glDisable(GL_BLEND);
    m_texture.draw(placement);
    glDisable(GL_SCISSOR_TEST);
    glUseProgram(0);
    return true;
}

}  // namespace pimgview
