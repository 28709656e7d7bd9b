/* SPDX-License-Identifier: BSD-3-Clause
 * A server that speaks iiod's protocol, with the chips of simulated_bus.h as two IIO devices behind it: libiio's own
 * client connects to it. Faults are set by name, in the bus and here. */
#ifndef TESTS_IIOD_MODEL_H
#define TESTS_IIOD_MODEL_H

#include <arpa/inet.h>
#include <errno.h>
#include <pthread.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <unistd.h>

#include "simulated_bus.h"

#define IIOD_CHANNEL(id, type)                                                                                         \
    "<channel id=\"" id "\" type=\"" type "\"><attribute name=\"raw\" filename=\"raw\"/>"                              \
    "<attribute name=\"scale\" filename=\"scale\"/><attribute name=\"offset\" filename=\"offset\"/></channel>"
#define IIOD_GRAMMAR                                                                                                   \
    "<!DOCTYPE context [<!ELEMENT context (device)*><!ELEMENT device (channel)*><!ELEMENT channel (attribute)*>"       \
    "<!ELEMENT attribute EMPTY><!ATTLIST context name CDATA #REQUIRED description CDATA #IMPLIED>"                     \
    "<!ATTLIST device id CDATA #REQUIRED name CDATA #IMPLIED>"                                                         \
    "<!ATTLIST channel id CDATA #REQUIRED type (input|output) #REQUIRED>"                                              \
    "<!ATTLIST attribute name CDATA #REQUIRED filename CDATA #IMPLIED>]>"
static const char iiod_context[] =
    "<?xml version=\"1.0\" encoding=\"utf-8\"?>" IIOD_GRAMMAR "<context name=\"model\" description=\"two converters\">"
    "<device id=\"iio:device0\" name=\"dac\">" IIOD_CHANNEL(
        "voltage0", "output") "</device>"
                              "<device id=\"iio:device1\" name=\"adc\">" IIOD_CHANNEL("voltage0", "input") IIOD_CHANNEL(
                                  "voltage1", "input") "<channel id=\"temp0\" type=\"input\"><attribute name=\"raw\" "
                                                       "filename=\"raw\"/></channel></device></context>";

typedef struct iiod_model {
    simulated_bus bus;
    atomic_int error;  /* errno of each number asked for; 0: none */
    atomic_int leaves; /* the next number asked for closes the connection */
    double scale[2];   /* of dac and adc [mV] */
    int listening, port;
    pthread_t serving;
} iiod_model;

static inline int iiod_raw(const iiod_model *m, int is_dac, int channel)
{
    if (m->bus.fault == BUS_ALL_ZERO || m->bus.fault == BUS_ALL_ONE)
        return m->bus.fault == BUS_ALL_ONE ? 0xFFFFFF : 0;
    if (is_dac)
        return (int)m->bus.dac;
    const double volts = channel == 0 ? simulated_volts(&m->bus) : simulated_deflection(&m->bus) / DEFLECTION_GAIN;
    const double code = floor(volts / 20.0 * 65536.0 + 0.5) + (double)(m->bus.noise >> 1 & 1u);
    return (int)(code > 32767.0 ? 32767.0 : code);
}

static inline void iiod_number(iiod_model *m, int to, const char *device, const char *channel, const char *name)
{
    const int is_dac = strcmp(device, "iio:device0") == 0, at = channel[strlen(channel) - 1] - '0';
    char text[32];
    ++m->bus.noise;
    if (strcmp(channel, "temp0") == 0 && strcmp(name, "raw") != 0) {
        (void)dprintf(to, "%d\n", -ENOENT);
        return;
    }
    if (strcmp(name, "raw") == 0)
        (void)snprintf(text, sizeof text, "%d", iiod_raw(m, is_dac, at));
    else if (strcmp(name, "scale") == 0)
        (void)snprintf(text, sizeof text, "%.9f", m->scale[!is_dac]);
    else
        (void)snprintf(text, sizeof text, "%d", is_dac ? -524288 : 0);
    (void)dprintf(to, "%zu\n%s\n", strlen(text), text);
}

/* One line of a client; 0: it goes. */
static inline int iiod_answer(iiod_model *m, FILE *from, int to, const char *line)
{
    char device[32], way[16], channel[32], name[32], value[64] = "";
    unsigned long size;
    if (strncmp(line, "VERSION", 7) == 0)
        return dprintf(to, "0.24.v0.24   \n") > 0;
    if (strncmp(line, "PRINT", 5) == 0)
        return dprintf(to, "%zu\n%s\n", strlen(iiod_context), iiod_context) > 0;
    if (strncmp(line, "TIMEOUT", 7) == 0)
        return dprintf(to, "0\n") > 0;
    const int reads = sscanf(line, "READ %31s %15s %31s %31s", device, way, channel, name) == 4;
    const int writes = sscanf(line, "WRITE %31s %15s %31s %31s %lu", device, way, channel, name, &size) == 5;
    if (writes && (size >= sizeof value || fread(value, 1, size, from) != size))
        return 0;
    if (!reads && !writes)
        return strncmp(line, "EXIT", 4) != 0 && dprintf(to, "%d\n", -EINVAL) > 0;
    if (atomic_exchange(&m->leaves, 0))
        return 0;
    if (atomic_load(&m->error) && strcmp(name, "raw") == 0)
        return dprintf(to, "%d\n", -atomic_load(&m->error)) > 0;
    if (reads) {
        iiod_number(m, to, device, channel, name);
        return 1;
    }
    if (m->bus.fault == BUS_WELL) /* a fault of the bus: it does not hear, either */
        m->bus.dac = (uint32_t)atol(value) & 0xFFFFFu;
    return dprintf(to, "%lu\n", size) > 0;
}

static inline void *iiod_serve(void *context)
{
    iiod_model *m = context;
    for (int to; (to = accept(m->listening, NULL, NULL)) >= 0;) {
        FILE *from = fdopen(dup(to), "r");
        char line[256];
        while (from && fgets(line, sizeof line, from) && iiod_answer(m, from, to, line))
            continue;
        if (from)
            (void)fclose(from);
        (void)shutdown(to, SHUT_RDWR);
        (void)close(to);
    }
    return NULL;
}

/* Serves on a free port of this machine; 0: it cannot. */
static inline int iiod_start(iiod_model *m)
{
    struct sockaddr_in at = {.sin_family = AF_INET, .sin_addr.s_addr = htonl(INADDR_LOOPBACK)};
    socklen_t size = sizeof at;
    m->bus = simulated_bus_after_power_up();
    m->bus.control = 0; /* the driver has switched the output on */
    m->bus.dac = 0x80000;
    m->scale[0] = 20000.0 / 1048575.0;
    m->scale[1] = 20000.0 / 65536.0;
    m->listening = socket(AF_INET, SOCK_STREAM, 0);
    if (m->listening < 0 || bind(m->listening, (struct sockaddr *)&at, size) != 0 || listen(m->listening, 4) != 0 ||
        getsockname(m->listening, (struct sockaddr *)&at, &size) != 0)
        return 0;
    m->port = ntohs(at.sin_port);
    return pthread_create(&m->serving, NULL, iiod_serve, m) == 0;
}

static inline void iiod_stop(iiod_model *m)
{
    (void)shutdown(m->listening, SHUT_RDWR);
    (void)pthread_join(m->serving, NULL);
    (void)close(m->listening);
}

#endif
