/* SPDX-License-Identifier: BSD-3-Clause
 * The reference session of the page's test: the same calls as tests/page/reference.mjs makes of the WebAssembly, and
 * every hundredth tick as a line: time, force, gap, in hexadecimal, so that no digit is lost. */
#include <stdio.h>
#include <stdlib.h>

#include "page.h"

enum { PIXELS = 65 };
static double heights[PIXELS * PIXELS];

int main(void)
{
    const double size = 500e-9, pixel = size / PIXELS;
    const page_opening opening = {0.5 * size, 0.5 * size, 0.1e-6, 30e-9, pixel, pixel, 1.0, 1.5};
    page_defaults();
    if (page_dots(heights, PIXELS, size) || page_open(heights, PIXELS, PIXELS, &opening))
        return 1;
    const double pushes[][2] = {{0.2, 3.0}, {0.8, 3.0}, {-0.4, 3.0}};
    for (int part = 0; part < 3; ++part) {
        if (page_push(pushes[part][0], (0.5 + 0.05 * part) * size, 0.5 * size, pushes[part][1]))
            return 2;
        for (int i = 0; i < 300; ++i) {
            if (page_run(100))
                return 3;
            const page_update *now = page_update_of();
            printf("%a %a %a\n", now->time, now->force, now->gap);
            page_taken();
        }
    }
    page_close();
    return 0;
}
