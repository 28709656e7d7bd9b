// SPDX-License-Identifier: BSD-3-Clause
// converters.h, hal_linux.h, hal_iio.h: a half on converters from a rig file
#include <array>
#include <chrono>
#include <cmath>
#include <cstring>
#include <memory>
#include <optional>
#include <vector>

#include "hal.h"
#include "internal/converters.h"
#include "nanotouch/advanced/hal_iio.h"
#include "nanotouch/advanced/hal_linux.h"
#ifdef NANOTOUCH_HAS_LINUX
#endif

// --- the tables of a rig file, whose numbers are SI by now ---

using Chips = std::array<nt_chip, NT_CONVERTERS>; // of IIO's drivers; others are in the library's tables

static nt_converter converter_of(const py::dict &table, nt_chip &own)
{
    if (table.contains("bits")) {
        const auto channels = static_cast<int>(table["channels"].cast<py::list>().size());
        own = nt_chip_of_iio(table["bits"].cast<int>(), channels, table["is_output"].cast<bool>());
        if (!own.name)
            raise(NT_E_RANGE, table["device"].cast<std::string>() + ": valid are 2 .. 24 bits and 1 .. 5 inputs, " +
                                  "or 2 .. 20 bits and 1 .. 4 outputs");
        return {&own, {table["low"].cast<double>(), table["high"].cast<double>()}};
    }
    const auto name = table["chip"].cast<std::string>();
    nt_converter made{};
    made.chip = nt_chip_find(name.c_str());
    if (!made.chip)
        raise(NT_E_ARGUMENT, "chip = '" + name + "' is none that is known");
    const auto clock = table["clock"].cast<double>();
    if (!(clock >= 1e3 && clock <= made.chip->clock)) // what its data sheet allows
        raise_on(NT_E_RANGE, {"clock", "Hz", clock, 1e3, made.chip->clock}, name);
    made.span = {table["low"].cast<double>(), table["high"].cast<double>()};
    return made;
}

static nt_converter_channel channel_of(const py::handle &given)
{
    nt_converter_channel made{};
    if (given.is_none())
        return made;
    const auto table = py::reinterpret_borrow<py::dict>(given);
    const auto number = [&](const char *name) { return table[name].cast<double>(); };
    made.is_used = 1;
    made.converter = table["converter"].cast<int>();
    made.channel = table["channel"].cast<int>();
    made.gain = number("gain");
    made.offset = number("offset");
    made.uncertainty = number("uncertainty");
    made.minimum = number("minimum");
    made.maximum = number("maximum");
    made.noise = number("noise");
    made.latency = number("latency");
    return made;
}

template <size_t count>
static void channels_of(const py::dict &setup, const char *name, nt_converter_channel (&to)[count])
{
    const auto list = setup[name].cast<py::list>();
    for (size_t i = 0; i < count && i < list.size(); ++i)
        to[i] = channel_of(list[i]);
}

static nt_converter_setup setup_of(const py::dict &given, Chips &own)
{
    nt_converter_setup made{};
    const auto chips = given["chips"].cast<py::list>();
    made.half = given["half"].cast<std::string>() == "master" ? NT_HALF_MASTER : NT_HALF_SLAVE;
    made.axes = given["axes"].cast<int>();
    if (chips.size() > NT_CONVERTERS)
        raise(NT_E_RANGE, std::to_string(chips.size()) + " chips: valid are 1 .. " + std::to_string(NT_CONVERTERS));
    made.converters = static_cast<int>(chips.size());
    for (int i = 0; i < made.converters; ++i)
        made.converter[i] = converter_of(chips[static_cast<size_t>(i)].cast<py::dict>(), own[static_cast<size_t>(i)]);
    channels_of(given, "position", made.position);
    channels_of(given, "felt", made.felt);
    channels_of(given, "driven", made.driven);
    channels_of(given, "lock_in", made.lock_in);
    made.exchange = nt_spi_exchange;
    return made;
}

// --- the half ---

static void open_spi(nt_spi &spi, const py::dict &setup)
{
    std::vector<std::string> paths;
    std::array<nt_spi_device, NT_CONVERTERS> devices{};
    const auto chips = setup["chips"].cast<py::list>();
    paths.reserve(chips.size());
    for (size_t i = 0; i < chips.size() && i < devices.size(); ++i) {
        const auto table = chips[i].cast<py::dict>();
        paths.push_back(table["device"].cast<std::string>());
        nt_chip own;
        devices[i] = {paths.back().c_str(), converter_of(table, own).chip->spi_mode, table["clock"].cast<double>()};
    }
    char reason[NT_SPI_REASON] = "";
    const nt_status status = nt_spi_open(&spi, devices.data(), static_cast<int>(chips.size()), nullptr, reason);
    if (status != NT_OK)
        raise(status, reason[0] ? reason : nt_status_message(status));
}

#ifdef NANOTOUCH_HAS_LINUX
static void open_iio(nt_iio &iio, const py::dict &setup)
{
    std::vector<std::string> words; // that the devices point to
    std::array<nt_iio_device, NT_CONVERTERS> devices{};
    const auto chips = setup["chips"].cast<py::list>();
    words.reserve(chips.size() * (NT_IIO_INPUTS + 1));
    for (size_t i = 0; i < chips.size() && i < devices.size(); ++i) {
        const auto table = chips[i].cast<py::dict>();
        const nt_converter on = converter_of(table, devices[i].chip);
        devices[i].span = on.span;
        words.push_back(table["device"].cast<std::string>());
        devices[i].device = words.back().c_str();
        const auto channels = table["channels"].cast<py::list>();
        for (size_t k = 0; k < channels.size(); ++k) {
            words.push_back(channels[k].cast<std::string>());
            devices[i].channels[k] = words.back().c_str();
        }
    }
    char reason[NT_IIO_REASON] = "";
    const auto uri = setup["context"].cast<std::string>();
    nt_status status = NT_OK;
    {
        const py::gil_scoped_release release; // a network may take seconds
        status = nt_iio_open(&iio, uri.c_str(), devices.data(), static_cast<int>(chips.size()), reason);
    }
    if (status == NT_E_UNSUPPORTED)
        raise(status, "built without libiio (libiio-dev, 0.23 or newer, below 1.0): backend \"iio\" cannot be used");
    if (status != NT_OK)
        raise(status, reason[0] ? reason : nt_status_message(status));
}
const nt_exchange iio_exchange = nt_iio_exchange;
const auto scan_iio = nt_iio_scan;
static void close_iio(nt_iio &iio)
{
    nt_iio_close(&iio);
}
#else // its functions are in nanotouch::linux
static void open_iio(nt_iio &, const py::dict &)
{
    raise(NT_E_UNSUPPORTED,
          "built without libiio (libiio-dev, 0.23 or newer, below 1.0): backend \"iio\" cannot be used");
}
const nt_exchange iio_exchange = nullptr;
static nt_status scan_iio(nt_iio *, int, const char *, double *, long)
{
    return NT_E_UNSUPPORTED;
}
static void close_iio(nt_iio &)
{
}
#endif

// spidev, or IIO where the rig file names its context.
struct Buses {
    nt_spi spi{};
    nt_iio iio{};
    bool is_iio;
    explicit Buses(const py::dict &setup) : is_iio(setup.contains("context"))
    {
        is_iio ? open_iio(iio, setup) : open_spi(spi, setup);
    }
    ~Buses()
    {
        is_iio ? close_iio(iio) : nt_spi_close(&spi);
    }
    void join(nt_converter_setup &setup)
    {
        setup.exchange = is_iio ? iio_exchange : nt_spi_exchange;
        setup.bus = is_iio ? static_cast<void *>(&iio) : &spi;
    }
    int error() const
    {
        return is_iio ? iio.error : spi.error;
    }
};

#ifdef NANOTOUCH_HAS_LINUX
struct Lines {
    nt_gpio *gpio = nullptr;
    explicit Lines(const py::handle &given)
    {
        if (given.is_none())
            return;
        const auto table = py::reinterpret_borrow<py::dict>(given);
        std::vector<std::string> names;
        names.reserve(5);
        const auto name = [&](const char *key) -> const char * {
            if (table[key].is_none())
                return nullptr;
            names.push_back(table[key].cast<std::string>());
            return names.back().c_str();
        };
        const nt_gpio_wiring wiring = {name("emergency_stop"), name("limit_switch"), name("laser_enable"),
                                       name("watchdog"),       name("convert"),      table["debounce"].cast<double>()};
        char reason[256] = "";
        const nt_status status = nt_gpio_open(&wiring, reason, sizeof reason, &gpio);
        if (status != NT_OK)
            raise(status, reason);
    }
    ~Lines()
    {
        nt_gpio_close(gpio);
    }
    nt_converter_lines lines() const
    {
        return gpio ? nt_gpio_lines(gpio) : nt_converter_lines{};
    }
};
#else
struct Lines {
    explicit Lines(const py::handle &given)
    {
        if (!given.is_none())
            raise(NT_E_UNSUPPORTED, "built without libgpiod: the lines of the rig file cannot be used");
    }
    static nt_converter_lines lines()
    {
        return {};
    }
};
#endif

struct ConverterHalf : Half {
    Buses buses;
    Lines lines;
    Chips own{};
    nt_converter_half half{};

    ConverterHalf(const py::dict &given, nt_half which) : buses(given), lines(given["lines"])
    {
        nt_converter_setup setup = setup_of(given, own);
        nt_problem problem{};
        buses.join(setup);
        setup.lines = lines.lines();
        raise_on(nt_converter_half_init(&half, &setup, &problem), problem, "rig");
        choice = {nt_converter_half_backend(which), &half};
    }
};

std::shared_ptr<Half> converter_half_of(const py::object &given, nt_half half)
{
    const auto setup = given.attr("setup").cast<py::dict>();
    const bool is_master = setup["half"].cast<std::string>() == "master";
    if (is_master != (half == NT_HALF_MASTER))
        throw py::type_error(std::string("these converters are the rig's ") + (is_master ? "master" : "slave"));
    return std::make_shared<ConverterHalf>(setup, half);
}

// And a step of the amplitude as its ADC reads it [m]; 0 without a lock-in amplifier.
static double check_converters(const py::dict &given)
{
    Chips own;
    const nt_converter_setup setup = setup_of(given, own);
    nt_problem problem = problem_of("", "", 0.0, 0.0, 0.0), one{};
    const nt_status status = nt_converter_setup_check(&setup, &problem);
    const auto half = given["half"].cast<std::string>();
    const auto keys = given["keys"].cast<std::vector<std::vector<std::string>>>();
    const nt_converter_channel *const kinds[] = {setup.position, setup.felt, setup.driven, setup.lock_in};
    for (size_t kind = 0; std::strncmp(problem.field, "channel.", 8) == 0 && kind < keys.size(); ++kind)
        for (size_t i = 0; i < keys[kind].size(); ++i)
            raise_on(nt_converter_channel_check(&setup, &kinds[kind][i], &one), one, half + "." + keys[kind][i]);
    raise_on(status, problem, half);
    const nt_converter_channel &amplitude = setup.lock_in[NT_LOCK_IN_AMPLITUDE];
    const nt_converter &on = setup.converter[amplitude.converter];
    return amplitude.is_used ? std::fabs(amplitude.gain) * nt_chip_step(on.chip, &on.span) : 0.0;
}

// Times of frames that change nothing, a list for each chip [s].
static std::vector<std::vector<double>> time_frames(const py::dict &given, int count)
{
    using Clock = std::chrono::steady_clock;
    Chips own;
    nt_converter_setup setup = setup_of(given, own);
    Buses buses(given);
    buses.join(setup);
    std::vector<std::vector<double>> found(static_cast<size_t>(setup.converters));
    const py::gil_scoped_release release;
    for (int i = 0; i < setup.converters; ++i) {
        const nt_chip *chip = setup.converter[i].chip;
        const nt_chip_frame frame = chip->is_dac ? nt_chip_ask(chip, 0) : nt_chip_poll(chip);
        for (int k = 0; k < count; ++k) {
            uint8_t in[NT_CHIP_FRAME_SIZE];
            const nt_transfer transfer = {frame.bytes, in, frame.count};
            const auto start = Clock::now();
            const nt_status status = setup.exchange(setup.bus, i, &transfer, 1);
            found[static_cast<size_t>(i)].push_back(std::chrono::duration<double>(Clock::now() - start).count());
            if (status != NT_OK) {
                const py::gil_scoped_acquire gil;
                raise(NT_E_DEVICE,
                      std::string(chip->name) + ": a frame failed: errno " + std::to_string(buses.error()));
            }
        }
    }
    return found;
}

// Scans of a chip's channels at a trigger; an array of count rows [V].
static py::array_t<double> iio_scan(const py::dict &given, int converter, long count,
                                    const std::optional<std::string> &trigger)
{
    const auto table = given["chips"].cast<py::list>()[static_cast<size_t>(converter)].cast<py::dict>();
    py::array_t<double> volts({static_cast<py::ssize_t>(count), static_cast<py::ssize_t>(py::len(table["channels"]))});
    double *to = volts.mutable_data();
    Buses buses(given);
    nt_status status = NT_OK;
    {
        const py::gil_scoped_release release;
        status = scan_iio(&buses.iio, converter, trigger ? trigger->c_str() : nullptr, to, count);
    }
    const auto device = table["device"].cast<std::string>();
    if (status == NT_E_ARGUMENT)
        raise(NT_E_UNSUPPORTED, device + ": its driver has no buffer for scans");
    if (status != NT_OK)
        raise(NT_E_DEVICE, device + ": no scans at " + (trigger ? "trigger '" + *trigger + "'" : "its trigger") + ": " +
                               std::strerror(buses.error()));
    return volts;
}

void bind_converters(py::module_ &core)
{
    py::module_ module = core.def_submodule("rigs");
    bind_drive(module);
    module.def("check_converters", check_converters);
    module.def("time_frames", time_frames);
    module.def("iio_scan", iio_scan);
    bind_timing(module);
    module.def("chips", [] {
        std::vector<std::string> names;
        for (int i = 0; nt_chip_at(i); ++i)
            names.emplace_back(nt_chip_at(i)->name);
        return names;
    });
}
