/* SPDX-License-Identifier: BSD-3-Clause
 * A plug-in of GIMP 2.10 that does with the operations what a user does, for gimp_test.py: it loads a picture, applies each
 * operation as GIMP's own filters are applied, undoes that, applies it with other values, and saves the result. Script-Fu
 * cannot call operations of GEGL, and no procedure of GIMP undoes: Ctrl+Z is sent to its window by xdotool, if there is one.
 * What came out is printed to `report`, a line for each check. */
#include <string.h>

#include <libgimp/gimp.h>

#define PROCEDURE "pimg-gimp-test"

/* An operation, a property of it and two values: what is applied first, and after undoing. */
typedef struct {
    const char *operation, *property;
    double first, second;
} Edit;

static const Edit edits[] = {
    { "pimg:hdr-compress", "saturation", 1.0, 0.2 },
    { "pimg:feature-lowpass", "strength", 0.1, 0.3 },
    { "pimg:detail-enhance", "gain", 2.0, 4.0 },
    { "pimg:level", "fraction", 0.05, 0.01 },
    { "pimg:wireframe", "fraction", 0.05, 0.01 },
    { "pimg:paint", "max", 24.0, 48.0 },
    { "pimg:mosaic", "grout", 1.5, 4.0 },
    { "pimg:ink", "density", 1.0, 0.5 },
};

static FILE* report = NULL;

static void say(const char* name, const char* what, gboolean right)
{
    fprintf(report, "%s %s: %s\n", name, what, right ? "yes" : "no");
    fflush(report);
}

/* The pixels of a layer as GIMP holds them, of 8 bits. */
static guchar* pixels_of(gint32 layer, gsize* size)
{
    GeglBuffer* buffer = gimp_drawable_get_buffer(layer);
    const GeglRectangle* box = gegl_buffer_get_extent(buffer);
    *size = (gsize)box->width * (gsize)box->height * 3;
    guchar* pixels = g_malloc(*size);
    gegl_buffer_get(buffer, box, 1.0, babl_format("R'G'B' u8"), pixels, GEGL_AUTO_ROWSTRIDE, GEGL_ABYSS_NONE);
    g_object_unref(buffer);
    return pixels;
}

static gboolean is_same(gint32 layer, const guchar* pixels)
{
    gsize size = 0;
    guchar* now = pixels_of(layer, &size);
    const gboolean same = memcmp(now, pixels, size) == 0;
    g_free(now);
    return same;
}

/* Applies an operation to a layer, so that it can be undone. */
static void apply(gint32 layer, const Edit* edit, double value)
{
    GeglBuffer *buffer = gimp_drawable_get_buffer(layer), *shadow = gimp_drawable_get_shadow_buffer(layer);
    GeglNode* graph = gegl_node_new();
    GeglNode* source = gegl_node_new_child(graph, "operation", "gegl:buffer-source", "buffer", buffer, NULL);
    GeglNode* filter = gegl_node_new_child(graph, "operation", edit->operation, NULL);
    GeglNode* sink = gegl_node_new_child(graph, "operation", "gegl:write-buffer", "buffer", shadow, NULL);
    gegl_node_set(filter, edit->property, value, NULL);
    gegl_node_link_many(source, filter, sink, NULL);
    gegl_node_process(sink);
    g_object_unref(graph);
    g_object_unref(shadow); /* before the merge: it is written when nobody holds it */
    g_object_unref(buffer);
    gimp_drawable_merge_shadow(layer, TRUE);
    gimp_drawable_update(layer, 0, 0, gimp_drawable_width(layer), gimp_drawable_height(layer));
    gimp_displays_flush();
}

/* Sends Ctrl+Z to GIMP's window until the layer has these pixels, for half a minute at most. */
static gboolean undo(gint32 layer, const guchar* pixels)
{
    for (int i = 0; i < 30; ++i) {
        g_spawn_command_line_sync("xdotool search --onlyvisible --class gimp key --window %@ ctrl+z", NULL, NULL, NULL,
                                  NULL);
        for (int j = 0; j < 10; ++j) {
            g_usleep(100000);
            if (is_same(layer, pixels))
                return TRUE;
        }
    }
    return FALSE;
}

static void try_edit(const char* folder, const Edit* edit, gboolean has_window)
{
    char* in = g_build_filename(folder, "in.png", NULL);
    const gint32 image = gimp_file_load(GIMP_RUN_NONINTERACTIVE, in, in);
    const gint32 layer = gimp_image_get_active_layer(image);
    gsize size = 0;
    guchar* before = pixels_of(layer, &size);
    const gint32 display = has_window ? gimp_display_new(image) : -1;
    apply(layer, edit, edit->first);
    say(edit->operation, "changes the layer", !is_same(layer, before));
    guchar* first = pixels_of(layer, &size);
    if (has_window) {
        say(edit->operation, "is undone", undo(layer, before));
        apply(layer, edit, edit->second);
        say(edit->operation, "is applied again with another value", !is_same(layer, before) && !is_same(layer, first));
    }
    for (int i = 0; i < 2; ++i) {
        char* out = g_strdup_printf("%s/%s.%s", folder, edit->operation + strlen("pimg:"), i == 0 ? "png" : "xcf");
        say(edit->operation, i == 0 ? "is saved as PNG" : "is saved as XCF",
            gimp_file_save(GIMP_RUN_NONINTERACTIVE, image, layer, out, out));
        g_free(out);
    }
    if (display != -1)
        gimp_display_delete(display);
    else
        gimp_image_delete(image);
    g_free(first);
    g_free(before);
    g_free(in);
}

static void query(void)
{
    static const GimpParamDef arguments[] = { { GIMP_PDB_INT32, "run-mode", "The run mode" },
                                              { GIMP_PDB_STRING, "folder", "Where in.png is" },
                                              { GIMP_PDB_INT32, "window", "Whether GIMP has a window" } };
    gimp_install_procedure(PROCEDURE, "Applies the operations of pimg", "Applies the operations of pimg", "pimg",
                           "pimg", "2026", NULL, NULL, GIMP_PLUGIN, G_N_ELEMENTS(arguments), 0, arguments, NULL);
}

static void run(const gchar* name, gint count, const GimpParam* arguments, gint* results, GimpParam** values)
{
    static GimpParam status[1];
    (void)name;
    (void)count;
    status[0].type = GIMP_PDB_STATUS;
    status[0].data.d_status = GIMP_PDB_SUCCESS;
    *results = 1;
    *values = status;
    gegl_init(NULL, NULL);
    const char* folder = arguments[1].data.d_string;
    char* path = g_build_filename(folder, "report.txt", NULL);
    report = fopen(path, "w");
    g_free(path);
    for (gsize i = 0; report != NULL && i < G_N_ELEMENTS(edits); ++i)
        try_edit(folder, &edits[i], arguments[2].data.d_int32 != 0);
    if (report != NULL) {
        fprintf(report, "all done: yes\n");
        fclose(report);
    }
}

const GimpPlugInInfo PLUG_IN_INFO = { NULL, NULL, query, run };

MAIN()
