/* SPDX-License-Identifier: BSD-3-Clause
 * Any datagrams at the example of a device in another process: only whole, new and possible ones count, and no time
 * lies in the future or runs backwards. */
#include "../../docs/examples/hal/pointer.c"

#include "input.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static int64_t host_clock;

static int64_t now_of(const nt_host *host)
{
    (void)host;
    return host_clock;
}

static const nt_host fuzz_host = {sizeof fuzz_host, NT_HAL_API_VERSION, now_of, NULL, NULL};

static void put_number(unsigned char *bytes, uint64_t value, int count)
{
    for (int i = 0; i < count; ++i)
        bytes[i] = (unsigned char)(value >> 8 * i);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    fuzz_input in = {data, size};
    nt_capabilities capabilities = {.size = sizeof capabilities};
    pointer p;
    p.is_open = 0;
    host_clock = 1000000000;
    REQUIRE(open_pointer(&p, &fuzz_host, NULL) == NT_OK && describe(&p, &capabilities) == NT_OK);
    while (in.size > 0) {
        uint8_t what;
        unsigned char report[MOST] = {0};
        fuzz_take(&in, &what, sizeof what);
        const size_t length = what & 1 ? REPORT : what;
        fuzz_take(&in, report, length);
        if (what & 1) { /* from a device, or from what knows its check sum */
            const double z = fuzz_double(&in, -0.01, 0.01);
            uint64_t bits;
            memcpy(&bits, &z, sizeof bits);
            memcpy(report, "NTP1", 4);
            put_number(report + 40, bits, 8);
            put_number(report + BODY, crc32_of(report, BODY), 4);
        }
        host_clock += what;
        const int64_t before = p.last;
        const int counts = understand(&p, report, (ssize_t)length);
        REQUIRE(!counts || (length == REPORT && fabs(p.reading.position[NT_Z]) <= 0.5 * TRAVEL));
        REQUIRE(!counts || (p.reading.time <= host_clock && p.last >= before));
    }
    close_pointer(&p);
    return 0;
}
