// SPDX-License-Identifier: BSD-3-Clause
// pimgview without its window: the stack and its command line, undo, and pictures made by threads.
#include "studio.h"

#include <algorithm>
#include <chrono>
#include <thread>

#include <gtest/gtest.h>

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imagebufalgo.h>
#include <OpenImageIO/imageio.h>

#include <pimg/imagebufalgo.h>

#include "display/viewport.h"
#include "render/glimpse.h"
#include "state/command_line.h"
#include "state/file_list.h"
#include "state/history.h"

namespace {

using namespace pimgview;

FilterStack stack_of(const std::string& line)
{
    std::vector<std::string> words;
    Script script;
    std::string error;
    EXPECT_TRUE(split_words(line, words, error) && parse_script(words, script, error)) << error;
    return script.stack;
}

/// A smooth picture with edges and some texture, written as floats.
std::string make_picture(int width, int height)
{
    OIIO::ImageBuf image(OIIO::ImageSpec(width, height, 3, OIIO::TypeFloat));
    for (OIIO::ImageBuf::Iterator<float> p(image); !p.done(); ++p)
        for (int c = 0; c < 3; ++c)
            p[c] = 0.1f + 0.01f * float(c + p.x() % 7) + (p.x() * 2 > width ? 4.0f : 0.0f)
                + 0.5f * float(p.y()) / float(height);
    const std::string name = "studio_" + std::to_string(width) + ".exr";
    EXPECT_TRUE(image.write(name));
    return name;
}

void wait_for(Studio& studio, const Wanted& wanted)
{
    for (int i = 0; i < 6000; ++i) {
        studio.want(wanted);
        if (studio.settled())
            return;
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    FAIL() << "not settled within a minute";
}

TEST(CommandLine, IsReadAsItWasWritten)
{
    const FilterStack stack = stack_of("pimgtool 'a b.exr' --build:guide=luma --hdr-compress:beta=20 "
                                       "--paint:canvas='\"C:x\"':max=12 --detail-enhance:curve=0:1,1:3 -o o.png");
    ASSERT_EQ(stack.items.size(), 3u);
    EXPECT_EQ(stack.items[1].texts[0].second, "C:x");
    EXPECT_EQ(stack_of(shell_line("it's.exr", stack, "b.png")), stack);
}

TEST(CommandLine, SaysWhatIsWrong)
{
    for (const std::string line :
         { "--hdr-compress:bata=1", "--hdr-compress:beta=nan", "--nothing", "-o", "--view:zoom=-1" }) {
        std::vector<std::string> words;
        Script script;
        std::string error;
        ASSERT_TRUE(split_words(line, words, error));
        EXPECT_FALSE(parse_script(words, script, error)) << line;
        EXPECT_EQ(error.find(line.substr(0, line.find(':'))), 0u) << error;
    }
    std::vector<std::string> words;
    std::string error;
    EXPECT_FALSE(split_words("--level 'a", words, error));
}

TEST(CommandLine, KeepsTheLook)
{
    LookOptions look;
    look.zoom = 2.5f;
    look.show = "split";
    Script script;
    std::string error;
    ASSERT_TRUE(parse_script({ look_argument(look) }, script, error)) << error;
    EXPECT_TRUE(script.look == look);
    EXPECT_EQ(look_argument({}), "");
}

TEST(FilterStack, EveryOptionOfEveryFilterCanBeSetAndReset)
{
    for (const pimg::Filter& filter : pimg::filter_table())
        for (const pimg::OptionInfo& option : filter.options()) {
            if (option.type != "int" && option.type != "float")
                continue;
            const SliderRange range = slider_range(option);
            EXPECT_LT(range.low, range.high) << filter.name << " " << option.key;
            StackItem item { &filter, {}, true };
            set_value(item, option, std::to_string(int(range.high)));
            pimg::BoundFilter bound;
            std::string error;
            EXPECT_TRUE(filter.bind(item.texts, bound, error)) << error;
            set_value(item, option, option.default_value);
            EXPECT_TRUE(item.texts.empty()) << filter.name << " " << option.key;
        }
}

TEST(FilterStack, LookingWritesNoFiles)
{
    FilterStack stack = stack_of("--paint:strokes=a.svg:max=40 --level");
    const pimg::OptionTexts texts = for_looking(stack.items[0], 4);
    EXPECT_EQ(texts, (pimg::OptionTexts { { "max", "10" } }));
    std::string error;
    ASSERT_TRUE(write_strokes(stack, "b.svg", error)) << error;
    EXPECT_EQ(stack.items[0].texts[0].second, "b.svg");
    stack.items[0].on = false;
    EXPECT_FALSE(write_strokes(stack, "c.svg", error));
    EXPECT_NE(error.find("c.svg"), std::string::npos);
}

TEST(FilterStack, TheLastOfTwoAlternativesHolds)
{
    StackItem item = stack_of("--level:splits=10").items[0];
    for (const pimg::OptionInfo& option : item.filter->options())
        if (option.key == "faces")
            set_value(item, option, "300");
    EXPECT_EQ(item.texts, (pimg::OptionTexts { { "faces", "300" } }));
}

TEST(FileList, FindsFramesAndFolders)
{
    std::string error;
    OIIO::Filesystem::remove_all("frames", error);
    ASSERT_TRUE(OIIO::Filesystem::create_directory("frames", error)) << error;
    const OIIO::ImageBuf picture(make_picture(16, 12));
    std::vector<std::string> names;
    for (const char* frame : { "0008", "0009", "0010" }) {
        names.push_back(std::string("frames/shot.") + frame + ".exr");
        ASSERT_TRUE(picture.write(names.back()));
    }
    for (const char* pattern : { "frames/shot.#.exr", "frames/shot.####.exr", "frames/shot.%04d.exr", "frames" })
        EXPECT_EQ(expand_files({ pattern }), names) << pattern;
    EXPECT_EQ(list_folder("."), list_folder("./"));
    ASSERT_TRUE(OIIO::Filesystem::create_directory("frames/none", error)) << error;
    EXPECT_EQ(expand_files({ "frames/none" }), (std::vector<std::string> { "frames/none" }));
}

TEST(History, GoesBackAndForth)
{
    History<int> history(0);
    for (const int state : { 1, 1, 2 })
        history.record(state);
    EXPECT_EQ(history.undo(), 1);
    EXPECT_EQ(history.undo(), 0);
    EXPECT_EQ(history.undo(), 0);
    EXPECT_EQ(history.redo(), 1);
    history.record(5);
    EXPECT_FALSE(history.can_redo());
    EXPECT_EQ(history.undo(), 1);
}

TEST(Viewport, ZoomKeepsThePlaceUnderThePointer)
{
    Viewport area { 10, 20, 640, 480, 2000, 1000 };
    LookOptions look;
    const double x = 200, y = 300;
    const auto place = [&] {
        return (x - area.left(look)) / area.zoom(look);
    };
    area.zoom_about(look, 4.0, x, y);
    const double before = place();
    area.zoom_about(look, 1.25, x, y);
    EXPECT_NEAR(place(), before, 1.0);
    area.pan(look, 50, 0);
    EXPECT_NEAR(place(), before - 50 / area.zoom(look), 1.0);
    const Region seen = area.visible(look);
    EXPECT_FALSE(seen.empty());
    EXPECT_TRUE((Region { 0, 0, 2000, 1000 }).contains(seen));
}

TEST(Studio, ShowsWhatTheFilterMakes)
{
    const std::string name = make_picture(160, 120);
    Studio studio([] {});
    studio.document().open(name, "", {});
    Wanted wanted;
    wanted.stack = stack_of("--hdr-compress:beta=20 --detail-enhance:gain=1.5");
    wait_for(studio, wanted);
    const std::shared_ptr<const Shown> shown = studio.shown();
    ASSERT_TRUE(shown && shown->final) << studio.error();
    pimg::HdrCompressOptions compress;
    compress.beta = 20.0f;
    pimg::DetailEnhanceOptions enhance;
    enhance.gain = 1.5f;
    const OIIO::ImageBuf expected =
        pimg::ImageBufAlgo::detail_enhance(pimg::ImageBufAlgo::hdr_compress(OIIO::ImageBuf(name), compress), enhance);
    EXPECT_EQ(OIIO::ImageBufAlgo::compare(*shown->result.pixels, expected, 0.0f, 0.0f).maxerror, 0.0);
    EXPECT_TRUE(shown->result.linear_light);
    // The texture holds those numbers, all of them.
    ASSERT_EQ(shown->frame->width, 160);
    float pixel[3];
    expected.getpixel(100, 50, pixel);
    EXPECT_EQ(shown->frame->rgb[3 * (50 * 160 + 100)], pixel[0]);
}

TEST(Studio, DraggingShowsASmallerCopyFirst)
{
    const std::string name = make_picture(1400, 1300);
    Studio studio([] {});
    studio.document().open(name, "", {});
    Wanted wanted;
    wait_for(studio, wanted);
    ASSERT_EQ(studio.document().state().rungs.size(), 3u);
    wanted.stack = stack_of("--hdr-compress");
    wanted.scale = 2.0;
    wanted.dragging = true;
    const int before = studio.shown()->serial;
    studio.want(wanted);
    for (int i = 0; i < 3000 && studio.shown()->serial == before; ++i)
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
    EXPECT_GT(studio.shown()->result.factor, 1);
    EXPECT_FALSE(studio.shown()->final);
    wanted.dragging = false;
    wait_for(studio, wanted);
    EXPECT_EQ(studio.shown()->result.factor, 1);
}

TEST(Studio, EndsWhileItBuilds)
{
    const std::string name = make_picture(1400, 1300);
    const auto begun = std::chrono::steady_clock::now();
    double closing = 0.0;
    {
        Studio studio([] {});
        studio.document().open(name, "", {});
        while (studio.document().state().activity != "building")
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        const auto asked = std::chrono::steady_clock::now();
        studio.stop();
        closing = std::chrono::duration<double>(std::chrono::steady_clock::now() - asked).count();
    }
    EXPECT_LT(closing, 0.5);
    EXPECT_LT(std::chrono::steady_clock::now() - begun, std::chrono::seconds(60));
}

/// A filter that takes long does not hold up the next setting.
TEST(Studio, LeavesAFilterWhoseSettingHasChanged)
{
    const std::string name = make_picture(1400, 1300);
    Studio studio([] {});
    studio.document().open(name, "", {});
    Wanted wanted;
    wait_for(studio, wanted);
    wanted.stack = stack_of("--paint");
    studio.want(wanted);
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    wanted.stack = stack_of("--level:fraction=0.5");
    wait_for(studio, wanted);
    EXPECT_TRUE(studio.error().empty()) << studio.error();
    EXPECT_EQ(studio.shown()->result.pixels->spec().width, 1400);
    wanted.stack = stack_of("--paint");
    studio.want(wanted);
    std::this_thread::sleep_for(std::chrono::milliseconds(300));
    EXPECT_TRUE(studio.stop()) << "closing waits for no filter";
}

TEST(Studio, ChoosesPartsAndLayers)
{
    OIIO::ImageSpec spec(64, 48, 6, OIIO::TypeFloat);
    spec.channelnames = { "diffuse.R", "diffuse.G", "diffuse.B", "specular.R", "specular.G", "specular.B" };
    const auto out = OIIO::ImageOutput::create("parts.exr");
    std::vector<OIIO::ImageSpec> specs(2, spec);
    specs[0].attribute("oiio:subimagename", "first");
    specs[1].attribute("oiio:subimagename", "second");
    ASSERT_TRUE(out->open("parts.exr", 2, specs.data())) << out->geterror();
    std::vector<float> samples(std::size_t(64 * 48 * 6));
    for (int part = 0; part < 2; ++part) {
        for (std::size_t i = 0; i < samples.size(); ++i)
            samples[i] = float(1 + part) * (i % 6 < 3 ? 0.1f : 0.4f);
        ASSERT_TRUE(part == 0 || out->open("parts.exr", specs[1], OIIO::ImageOutput::AppendSubimage));
        ASSERT_TRUE(out->write_image(OIIO::TypeFloat, samples.data())) << out->geterror();
    }
    ASSERT_TRUE(out->close());
    Studio studio([] {});
    studio.document().open("parts.exr", "second", { { "layer", "specular" } });
    wait_for(studio, {});
    const DocumentState state = studio.document().state();
    EXPECT_EQ(state.error, "");
    EXPECT_EQ(state.parts, (std::vector<std::string> { "first", "second" }));
    EXPECT_EQ(state.layers, (std::vector<std::string> { "diffuse", "specular" }));
    ASSERT_TRUE(studio.shown());
    EXPECT_EQ(studio.shown()->frame->rgb[0], 0.8f);
    const FilterStack stack = stack_of("pimgtool --part second parts.exr --build:layer=specular --level");
    EXPECT_EQ(stack.part, "second");
    EXPECT_EQ(shell_line("parts.exr", stack, "o.png"),
              "pimgtool --part second parts.exr --build:layer=specular --level -o o.png");
}

TEST(Studio, SaysWhyAFileCannotBeRead)
{
    Studio studio([] {});
    studio.document().open("nowhere.exr", "", {});
    wait_for(studio, {});
    EXPECT_NE(studio.document().state().error.find("nowhere.exr"), std::string::npos);
    studio.document().open(make_picture(160, 120), "", { { "guide", "purple" } });
    wait_for(studio, {});
    EXPECT_NE(studio.document().state().error.find("guide"), std::string::npos);
}

/// Of a .pimg file and of a texture there is a small picture at once.
TEST(Studio, GlimpsesAtFiles)
{
    const std::string name = make_picture(420, 301);
    const OIIO::ImageBuf whole(name);
    Studio studio([] {});
    studio.document().open(name, "", {});
    wait_for(studio, {});
    studio.save({}, "glimpsed.pimg");
    wait_for(studio, {});
    ASSERT_FALSE(studio.saving().failed) << studio.saving().text;
    ASSERT_TRUE(
        OIIO::ImageBufAlgo::make_texture(OIIO::ImageBufAlgo::MakeTxTexture, whole, "glimpsed.tif", OIIO::ImageSpec()));
    for (const char* file : { "glimpsed.pimg", "glimpsed.tif" }) {
        const Glimpse look = glimpse(file, "", { 1e4, 0.0 });
        EXPECT_EQ(look.parts.size(), 1u);
        EXPECT_EQ(look.bytes, 420.0 * 301 * 3 * 4) << file;
        ASSERT_TRUE(look.pixels) << file;
        EXPECT_GT(look.factor, 1);
        const OIIO::ImageBuf means = reduced(whole, look.factor);
        EXPECT_EQ(look.pixels->spec().width, means.spec().width);
        EXPECT_EQ(look.pixels->spec().height, means.spec().height);
        // The texture of the picture is no part of the mesh layer; its step, by 4, is.
        EXPECT_LT(OIIO::ImageBufAlgo::compare(*look.pixels, means, 0.0f, 0.0f).meanerror, 0.1) << file;
        EXPECT_FALSE(glimpse(file, "", {}).pixels) << "what is read soon needs none";
    }
    EXPECT_TRUE(glimpse("nowhere.exr", "", {}).parts.empty());
}

/// The glimpse of a large file is shown and filtered until the file has been read.
TEST(Studio, ShowsAGlimpseBeforeTheFile)
{
    const OIIO::ImageBuf whole(make_picture(2100, 1500));
    ASSERT_TRUE(
        OIIO::ImageBufAlgo::make_texture(OIIO::ImageBufAlgo::MakeTxTexture, whole, "large.tif", OIIO::ImageSpec()));
    Studio studio([] {});
    studio.document().open("large.tif", "", {});
    bool glimpsed = false;
    DocumentState state;
    for (int i = 0; i < 60000 && !(state.is_read() && built_rung(state, 1e9) && !state.rungs.back().glimpse); ++i) {
        state = studio.document().state();
        glimpsed = glimpsed || (state.has_picture() && !state.is_read() && state.rungs[0].image);
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    EXPECT_TRUE(glimpsed);
    EXPECT_EQ(state.error, "");
    EXPECT_EQ(state.rungs[0].factor, 1);
    EXPECT_EQ(state.width, 2100);
}

/// What was read stays, whatever becomes of the file.
TEST(Studio, NeedsNoFileOnceItIsRead)
{
    const std::string name = make_picture(160, 120);
    Studio studio([] {});
    studio.document().open(name, "", {});
    wait_for(studio, {});
    ASSERT_TRUE(OIIO::Filesystem::remove(name));
    studio.document().rebuild({ { "guide", "luma" } });
    wait_for(studio, {});
    EXPECT_EQ(studio.document().state().error, "");
    studio.save({}, "after.exr");
    wait_for(studio, {});
    EXPECT_FALSE(studio.saving().failed) << studio.saving().text;
    EXPECT_GT(studio.memory(), std::size_t(160 * 120 * 3 * 4));
    studio.document().open(name, "", {});
    wait_for(studio, {});
    EXPECT_NE(studio.document().state().error.find(name), std::string::npos);
}

TEST(Studio, SavesWhatIsShown)
{
    const std::string name = make_picture(160, 120);
    Studio studio([] {});
    studio.document().open(name, "", {});
    Wanted wanted;
    wanted.stack = stack_of("--level:fraction=0.1");
    wait_for(studio, wanted);
    for (const char* file : { "saved.exr", "saved.pimg" }) {
        studio.save(wanted.stack, file);
        wait_for(studio, wanted);
        EXPECT_FALSE(studio.saving().failed) << studio.saving().text;
    }
    const OIIO::ImageBuf saved("saved.exr");
    EXPECT_EQ(OIIO::ImageBufAlgo::compare(saved, *studio.shown()->result.pixels, 0.0f, 0.0f).maxerror, 0.0);
    studio.save(stack_of("--paint:max=20"), "strokes.svg");
    wait_for(studio, wanted);
    EXPECT_TRUE(OIIO::Filesystem::exists("strokes.svg")) << studio.saving().text;
    studio.save(wanted.stack, "nowhere/saved.exr");
    wait_for(studio, wanted);
    EXPECT_TRUE(studio.saving().failed);
}

}  // namespace
