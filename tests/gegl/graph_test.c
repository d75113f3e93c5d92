/* SPDX-License-Identifier: BSD-3-Clause
 * A graph as GIMP has it: a property changes, the pixels do not. The node keeps its hierarchy, and gives what a new
 * node gives. */
#include <stdio.h>
#include <string.h>

#include <gegl.h>

enum { width = 400, height = 300 };

static GeglBuffer* picture(float brightness)
{
    GeglBuffer* buffer = gegl_buffer_new(GEGL_RECTANGLE(0, 0, width, height), babl_format("RGBA float"));
    float* pixels = g_new(float, width* height * 4);
    for (int i = 0; i < width * height; ++i) {
        const int x = i % width, y = i / width;
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

    g_object_unref(graph);
    g_object_unref(dim);
    g_object_unref(bright);
    gegl_exit();
    return failures;
}
