/* SPDX-License-Identifier: BSD-3-Clause
 * A graph as GIMP has it: a property changes, the pixels do not. The node keeps its hierarchy, and gives what a new
 * node gives. While it renders, its properties can be asked for: nobody has to wait for the filter. */
#include <stdio.h>
#include <string.h>

#include <gegl.h>

enum { width = 400, height = 300 };

static GeglBuffer* picture_of_size(int across, int down, float brightness)
{
    GeglBuffer* buffer = gegl_buffer_new(GEGL_RECTANGLE(0, 0, across, down), babl_format("RGBA float"));
    float* pixels = g_new(float, across* down * 4);
    for (int i = 0; i < across * down; ++i) {
        const int x = i % across, y = i / across;
        const float light =
            brightness * (x > 250 && y < 150 ? 80.0f : 0.2f) * (1.0f + 0.1f * (float)((x * 31 + y * 17) % 97) / 97.0f);
        for (int c = 0; c < 3; ++c)
            pixels[4 * i + c] = light * (1.0f - 0.1f * (float)c);
        pixels[4 * i + 3] = 1.0f;
    }
    gegl_buffer_set(buffer, NULL, 0, babl_format("RGBA float"), pixels, GEGL_AUTO_ROWSTRIDE);
    g_free(pixels);
    return buffer;
}

static GeglBuffer* picture(float brightness)
{
    return picture_of_size(width, height, brightness);
}

static GeglNode* new_filter(GeglNode* graph, GeglNode* source, double beta)
{
    GeglNode* node =
        gegl_node_new_child(graph, "operation", "pimg:hdr-compress", "fit", FALSE, "s0", 0.3, "beta", beta, NULL);
    gegl_node_link(source, node);
    return node;
}

/* Renders and returns how long that took, in seconds. */
static double render(GeglNode* node, float* result)
{
    const gint64 start = g_get_monotonic_time();
    gegl_node_blit(node, 1.0, GEGL_RECTANGLE(0, 0, width, height), babl_format("RGBA float"), result,
                   GEGL_AUTO_ROWSTRIDE, GEGL_BLIT_DEFAULT);
    return (double)(g_get_monotonic_time() - start) / 1e6;
}

static gint rendered = 0;

static gpointer render_a_pixel(gpointer node)
{
    float pixel[4];
    gegl_node_blit(node, 1.0, GEGL_RECTANGLE(0, 0, 1, 1), babl_format("RGBA float"), pixel, GEGL_AUTO_ROWSTRIDE,
                   GEGL_BLIT_DEFAULT);
    g_atomic_int_set(&rendered, 1);
    return NULL;
}

/* The longest that a property kept one waiting, as a share of the time the node took to build and filter. */
static double longest_wait(GeglNode* node)
{
    const gint64 start = g_get_monotonic_time();
    gint64 longest = 0;
    GThread* thread = g_thread_new("renders", render_a_pixel, node);
    while (!g_atomic_int_get(&rendered)) {
        double beta = 0.0;
        const gint64 asked = g_get_monotonic_time();
        gegl_node_get(node, "beta", &beta, NULL);
        longest = MAX(longest, g_get_monotonic_time() - asked);
        g_usleep(1000);
    }
    g_thread_join(thread);
    return (double)longest / (double)(g_get_monotonic_time() - start);
}

int main(int argc, char** argv)
{
    gegl_init(&argc, &argv);
    static float first[width * height * 4], again[width * height * 4], fresh[width * height * 4];
    GeglBuffer *dim = picture(1.0f), *bright = picture(3.0f);
    GeglNode* graph = gegl_node_new();
    GeglNode* source = gegl_node_new_child(graph, "operation", "gegl:buffer-source", "buffer", dim, NULL);
    GeglNode* node = new_filter(graph, source, 2.0);
    int failures = 0;

    const double building = render(node, first);
    double sweeping = building;
    for (int i = 0; i < 3; ++i) {
        gegl_node_set(node, "beta", 5.0 + i, NULL);
        const double seconds = render(node, again);
        sweeping = MIN(sweeping, seconds);
    }
    render(new_filter(graph, source, 7.0), fresh);
    printf("built in %.3f s, swept in %.3f s\n", building, sweeping);
    failures += sweeping > building / 2.0;
    failures += memcmp(first, again, sizeof first) == 0;
    failures += memcmp(again, fresh, sizeof again) != 0;

    gegl_node_set(source, "buffer", bright, NULL);
    render(node, again);
    render(new_filter(graph, source, 7.0), fresh);
    failures += memcmp(again, first, sizeof first) == 0;
    failures += memcmp(again, fresh, sizeof again) != 0;

    GeglBuffer* large = picture_of_size(3 * width, 3 * height, 1.0f);
    GeglNode* large_source = gegl_node_new_child(graph, "operation", "gegl:buffer-source", "buffer", large, NULL);
    const double waited = longest_wait(new_filter(graph, large_source, 2.0));
    printf("waited for a property for %.4f of a rendering\n", waited);
    failures += waited > 0.5;

    g_object_unref(graph);
    g_object_unref(large);
    g_object_unref(dim);
    g_object_unref(bright);
    gegl_exit();
    return failures;
}
