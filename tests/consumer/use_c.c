/* SPDX-License-Identifier: BSD-3-Clause
 * The C interface: one pixel, one filter. */
#include <stdio.h>

#include <pimg/pimg.h>

int main(void)
{
    float pixel[3] = { 4.0f, 2.0f, 1.0f }, result[3] = { -1.0f, -1.0f, -1.0f };
    const pimg_pixels in = { pixel, 1, 1, 3, 0, 0 }, out = { result, 1, 1, 3, 0, 0 };
    pimg_image* image = pimg_build(&in, NULL, NULL, 0);
    const bool done = image != NULL && pimg_render(image, "hdr_compress", &out, 0, 0, 0, NULL, 0);
    pimg_free(image);
    puts(pimg_version());
    return done && result[0] > result[1] && result[1] > result[2] && result[2] > 0.0f ? 0 : 1;
}
