/* SPDX-License-Identifier: BSD-3-Clause
 * The C interface from C: strides, windows, filters, errors. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <pimg/pimg.h>

enum { width = 61, height = 47, channels = 4 };

static int failures = 0;

#define CHECK(condition)                                                                                               \
    do {                                                                                                               \
        if (!(condition)) {                                                                                            \
            fprintf(stderr, "line %d: not true: %s\n", __LINE__, #condition);                                          \
            ++failures;                                                                                                \
        }                                                                                                              \
    } while (0)

static float pixels[width * height * channels];

/* Shades and a window ten stops brighter. */
static void draw(void)
{
    for (int i = 0; i < width * height; ++i) {
        const int x = i % width, y = i / width;
        const float light = (x > 35 && y < 25 ? 100.0f : 0.1f) * (1.0f + 0.01f * (float)((x * 7 + y * 13) % 17));
        for (int c = 0; c < 3; ++c)
            pixels[channels * i + c] = light * (1.0f - 0.2f * (float)c);
        pixels[channels * i + 3] = 0.5f;
    }
}

static pimg_pixels packed(float* data, int w, int h)
{
    const pimg_pixels result = { data, w, h, channels, 0, 0 };
    return result;
}

static void test_what_changes_nothing(const pimg_image* image)
{
    static float result[width * height * channels];
    const pimg_pixels out = packed(result, width, height);
    char error[200] = "untouched";
    CHECK(pimg_render(image, "level", &out, 0, 0, 0, error, sizeof error));
    for (int i = 0; i < width * height * channels; ++i)
        CHECK(fabsf(result[i] - pixels[i]) < 1e-3f);
    CHECK(pimg_render(image, "feature-lowpass:strength=0", &out, 0, 0, 0, error, sizeof error));
    CHECK(memcmp(result, pixels, sizeof pixels) == 0);
    CHECK(strcmp(error, "untouched") == 0);
    CHECK(pimg_memory(image) > sizeof pixels);
}

/* Windows, also such that stick out of the picture, hold what the whole result holds, and nothing else is written. */
static void test_windows(const pimg_image* image, const char* filter)
{
    static float whole[width * height * channels];
    const pimg_pixels out = packed(whole, width, height);
    CHECK(pimg_render(image, filter, &out, 0, 0, 0, NULL, 0));
    CHECK(memcmp(whole, pixels, sizeof pixels) != 0);
    for (int y = -16; y < height; y += 16)
        for (int x = -16; x < width; x += 16) {
            enum { side = 16, row = side * channels + 5 };
            float tile[side * row];
            for (int i = 0; i < side * row; ++i)
                tile[i] = -7.0f;
            const pimg_pixels window = { tile, side, side, channels, 0, row * (ptrdiff_t)sizeof(float) };
            CHECK(pimg_render(image, filter, &window, x, y, 1, NULL, 0));
            for (int i = 0; i < side * row; ++i) {
                const int px = x + i % row / channels, py = y + i / row;
                const int inside = i % row < side * channels && px >= 0 && px < width && py >= 0 && py < height;
                const float expected = inside ? whole[channels * (py * width + px) + i % row % channels] : -7.0f;
                CHECK(tile[i] == expected);
            }
        }
}

/* Rows from the bottom up, and pixels with something between them. */
static void test_strides(void)
{
    enum { step = channels + 2 };
    static float spread[width * height * step], expected[width * height * channels];
    for (int i = 0; i < width * height; ++i)
        memcpy(&spread[step * ((height - 1 - i / width) * width + i % width)], &pixels[channels * i],
               channels * sizeof(float));
    pimg_pixels bottom_up = { &spread[step * (height - 1) * width],      width, height, channels, step * sizeof(float),
                              -(ptrdiff_t)(step * width * sizeof(float)) };
    const pimg_pixels plain = packed(pixels, width, height), out = packed(expected, width, height);
    pimg_image* a = pimg_build(&plain, "", NULL, 0);
    pimg_image* b = pimg_build(&bottom_up, NULL, NULL, 0);
    CHECK(a != NULL && b != NULL);
    CHECK(pimg_render(a, "hdr_compress", &out, 0, 0, 0, NULL, 0));
    CHECK(pimg_render(b, "hdr_compress", &bottom_up, 0, 0, 0, NULL, 0));
    for (int i = 0; i < width * height; ++i)
        CHECK(memcmp(&spread[step * ((height - 1 - i / width) * width + i % width)], &expected[channels * i],
                     channels * sizeof(float))
              == 0);
    pimg_free(a);
    pimg_free(b);
}

/* Waves that continue across the sides: there are no more steps at the seam than elsewhere. */
static void test_sides_that_meet(void)
{
    char error[200] = "";
    static float waves[width * height * channels], result[width * height * channels];
    const pimg_pixels picture = packed(waves, width, height), out = packed(result, width, height);
    float steps[2] = { 0.0f, 0.0f };
    for (int i = 0; i < width * height * channels; ++i) {
        const int x = i / channels % width, y = i / channels / width;
        waves[i] = 1.0f + 0.5f * sinf(6.2831853f * ((float)x / width + (float)y / height))
            + 0.1f * (float)((x * 31 + y * 17) % 97) / 97.0f;
    }
    const char* const wraps[2] = { "wrap=none", "wrap=xy:layer=\"\"" };
    for (int w = 0; w < 2; ++w) {
        pimg_image* image = pimg_build(&picture, wraps[w], error, sizeof error);
        CHECK(image != NULL && pimg_render(image, "level:faces=100", &out, 0, 0, 0, error, sizeof error));
        pimg_free(image);
        for (int y = 0; y < height; ++y) {
            const float step = result[y * width * channels] - result[((y + 1) * width - 1) * channels];
            steps[w] += step > 0 ? step : -step;
        }
    }
    CHECK(steps[1] < 0.5f * steps[0]);
}

static void test_labels(const pimg_image* image)
{
    static float labels[width * height];
    const pimg_pixels out = { labels, width, height, 1, 0, 0 };
    CHECK(pimg_render(image, "segment:regions=20", &out, 0, 0, 0, NULL, 0));
    float most = 0.0f;
    for (int i = 0; i < width * height; ++i) {
        CHECK(labels[i] == floorf(labels[i]));
        most = fmaxf(most, labels[i]);
    }
    CHECK(most == 19.0f);
}

static void expect_error(bool done, const char* error, const char* says)
{
    if (done || strstr(error, says) == NULL || strchr(error, '\n') != NULL) {
        fprintf(stderr, "expected an error with \"%s\", got \"%s\"\n", says, error);
        ++failures;
    }
}

static void test_errors(const pimg_image* image)
{
    char error[200] = "";
    static float result[width * height * channels];
    const pimg_pixels out = packed(result, width, height), none = { NULL, 1, 1, 1, 0, 0 };
    const pimg_pixels empty = { result, 0, 4, 4, 0, 0 }, odd = { result, 4, 4, -1, 0, 0 };
    static const struct {
        const char *filter, *says;
    } bad[] = {
        { "hdr_compress:beta=-1", "expected a number, 0 to 1000" },
        { "hdr_compress:betta=1", "unknown option \"betta\"" },
        { "hdr_compress:beta", "expected key=value" },
        { "hdr_compress:=3", "expected key=value" },
        { "paint:canvas=\"1,1,1", "end with one" },
        { "sharpen", "unknown filter" },
        { "", "unknown filter" },
        { "level:faces=3:splits=4", "only one of them" },
        { "paint:brush=nowhere.png", "nowhere.png" },
    };
    for (size_t i = 0; i < sizeof bad / sizeof *bad; ++i)
        expect_error(pimg_render(image, bad[i].filter, &out, 0, 0, 0, error, sizeof error), error, bad[i].says);
    static const int far_away[] = { -2147483647 - 1, 2147483647, -(1 << 30) - 1, (1 << 30) + 1 };
    for (size_t i = 0; i < sizeof far_away / sizeof *far_away; ++i) {
        expect_error(pimg_render(image, "level", &out, far_away[i], 0, 0, error, sizeof error), error, "x, y");
        expect_error(pimg_render(image, "level", &out, 0, far_away[i], 0, error, sizeof error), error, "x, y");
    }
    expect_error(pimg_render(NULL, "ink", &out, 0, 0, 0, error, sizeof error), error, "image");
    expect_error(pimg_render(image, NULL, &out, 0, 0, 0, error, sizeof error), error, "filter");
    expect_error(pimg_render(image, "ink", NULL, 0, 0, 0, error, sizeof error), error, "result");
    expect_error(pimg_render(image, "ink", &none, 0, 0, 0, error, sizeof error), error, "result");
    expect_error(pimg_build(NULL, "", error, sizeof error) != NULL, error, "picture");
    expect_error(pimg_build(&empty, "", error, sizeof error) != NULL, error, "0 x 4");
    expect_error(pimg_build(&odd, "", error, sizeof error) != NULL, error, "-1 channels");
    expect_error(pimg_build(&out, "guide=x", error, sizeof error) != NULL, error, "one of luma, log, rgb");
    expect_error(pimg_build(&out, "incolorspace=nowhere", error, sizeof error) != NULL, error, "nowhere");

    /* Samples in memory have no names, so there is one layer, that without a name. */
    expect_error(pimg_build(&out, "layer=fill", error, sizeof error) != NULL, error, "layer=");
    expect_error(pimg_build(&out, "wrap=y", error, sizeof error) != NULL, error, "one of none, x, xy");

    char small[8] = "1234567";
    CHECK(!pimg_render(image, "sharpen", &out, 0, 0, 0, small, sizeof small));
    CHECK(strcmp(small, "unknown") == 0);
    CHECK(!pimg_render(image, "sharpen", &out, 0, 0, 0, NULL, 0));
}

int main(void)
{
    draw();
    const pimg_pixels picture = packed(pixels, width, height);
    char error[200] = "";
    pimg_image* image = pimg_build(&picture, "base=64", error, sizeof error);
    if (image == NULL) {
        fprintf(stderr, "%s\n", error);
        return 1;
    }
    test_what_changes_nothing(image);
    test_windows(image, "hdr_compress:s0=0.2:beta=4");
    test_windows(image, "paint:canvas=\"1,1,1\":seed=3");
    test_strides();
    test_sides_that_meet();
    test_labels(image);
    test_errors(image);
    pimg_free(image);
    pimg_free(NULL);
    CHECK(strlen(pimg_version()) >= 5);
    return failures == 0 ? 0 : 1;
}
