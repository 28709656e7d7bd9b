// SPDX-License-Identifier: BSD-3-Clause
// hal_linux.h: what `nanotouch doctor` lists
#ifdef NANOTOUCH_HAS_LINUX
#include "chapters.h"
#include "nanotouch/advanced/hal_linux.h"

void bind_linux(py::module_ &module)
{
    module.def("gpio_lines", [] {
        py::list lines;
        const long count = nt_gpio_line_count();
        for (long i = 0; i < count; ++i) {
            nt_gpio_line line;
            if (nt_gpio_line_at(i, &line) == NT_OK)
                lines.append(py::make_tuple(line.chip, line.offset, line.name, line.consumer));
        }
        return lines;
    });
}
#endif
