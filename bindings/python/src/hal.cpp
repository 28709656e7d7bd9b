// SPDX-License-Identifier: BSD-3-Clause
// hal.h: halves of a rig from Python, and the rehearsal of one
#include "hal.h"

#include <chrono>
#include <cmath>
#include <cstring>
#include <exception>
#include <thread>
#include <utility>
#include <vector>

static py::object hal_name(const char *name)
{
    return py::module_::import("nanotouch.touch.hal").attr(name);
}

py::str text_of(const char *text)
{
    PyObject *decoded = PyUnicode_DecodeUTF8(text, static_cast<py::ssize_t>(std::strlen(text)), "replace");
    if (!decoded)
        throw py::error_already_set();
    return py::reinterpret_steal<py::str>(decoded);
}

// --- a shared object ---

struct ModuleHalf : Half {
    nt_module module{};

    ModuleHalf(const py::object &given, nt_half half)
    {
        option = given.attr("option").cast<std::string>();
        const nt_status status = nt_hal_load(&module, given.attr("path").cast<std::string>().c_str(), half);
        if (status != NT_OK)
            raise(status, module.text);
        choice = {module.backend, nullptr};
    }
    ~ModuleHalf() override
    {
        nt_hal_unload(&module);
    }
};

// --- an object of a Python class ---

// What open is given; the half is cut off from it by close.
struct Host {
    const nt_host *host;
    const nt_host &get() const
    {
        if (!host)
            throw py::value_error("this half is closed: its host is gone");
        return *host;
    }
};

struct PythonHalf : Half {
    py::object self, reading_type, action_type, states;
    std::string name;
    nt_backend backend{};
    std::shared_ptr<Host> host = std::make_shared<Host>(Host{nullptr});
    uint64_t sequence = 0;
    Rows channels;
    std::exception_ptr error; // the first one that a method has raised

    PythonHalf(py::object given, nt_half half);
    ~PythonHalf() override // what close has raised has no caller any more
    {
        try {
            rethrow();
        } catch (py::error_already_set &last) {
            last.discard_as_unraisable(name.c_str());
        } catch (...) { // nothing else comes from Python
        }
    }
    void rethrow() final
    {
        if (error)
            std::rethrow_exception(std::exchange(error, nullptr));
    }
};

// The loop learns that the device has failed; the caller, later, why.
template <class Call> static nt_status guarded(void *context, Call call)
{
    auto &half = *static_cast<PythonHalf *>(context);
    const py::gil_scoped_acquire gil;
    try {
        call(half);
        return NT_OK;
    } catch (...) {
        if (!half.error)
            half.error = std::current_exception();
        return NT_E_DEVICE;
    }
}

static nt_status open_python(void *context, const nt_host *host, nt_problem *)
{
    return guarded(context, [host](PythonHalf &half) {
        half.host->host = host;
        half.sequence = 0;
        half.self.attr("open")(half.host);
    });
}

void Rows::take(const py::list &channels)
{
    words.clear();
    words.reserve(2 * channels.size()); // so that none of them moves
    rows.clear();
    for (const py::handle channel : channels) {
        const auto word = [&](const char *attribute) {
            words.push_back(channel.attr(attribute).cast<std::string>());
            return words.back().c_str();
        };
        const auto number = [&](const char *attribute) { return channel.attr(attribute).cast<double>(); };
        rows.push_back({word("name"), word("unit"), channel.attr("driven").cast<bool>(),
                        channel.attr("axis").cast<int>(), number("minimum"), number("maximum"), number("step"),
                        number("noise"), number("latency"), number("safe")});
    }
}

uint32_t can_of(const py::object &capabilities)
{
    if (!py::isinstance(capabilities, hal_name("Capabilities")))
        throw py::type_error("describe: it must return a nanotouch.hal.Capabilities, not " +
                             py::repr(capabilities).cast<std::string>());
    const auto bit = [&](const char *name, uint32_t value) {
        return capabilities.attr(name).cast<bool>() ? value : 0u;
    };
    return bit("feels", NT_CAN_FEEL) | bit("pushes", NT_CAN_PUSH) | bit("servos", NT_CAN_SERVO) |
           bit("event_driven", NT_IS_EVENT_DRIVEN) | bit("taps", NT_CAN_TAP);
}

static nt_status describe_python(void *context, nt_capabilities *capabilities)
{
    return guarded(context, [capabilities](PythonHalf &half) {
        const py::object found = half.self.attr("describe")();
        capabilities->can = can_of(found) | NT_IS_SLOW;
        capabilities->axes = found.attr("axes").cast<int>();
        capabilities->period = found.attr("period").cast<double>();
        half.channels.take(found.attr("channels").cast<py::list>());
        capabilities->rows = static_cast<int>(half.channels.rows.size());
        capabilities->channels = half.channels.rows.data();
    });
}

static nt_status configure_python(void *context, const nt_configuration *configuration, nt_problem *)
{
    return guarded(context, [configuration](PythonHalf &half) {
        half.self.attr("configure")(
            hal_name("Configuration")(configuration->period, configuration->lift, configuration->option));
    });
}

static nt_status arm_python(void *context)
{
    return guarded(context, [](PythonHalf &half) { half.self.attr("arm")(); });
}

// A number of a reading, or what it must be in words.
template <typename Number> static Number number_of(const py::object &given, const std::string &name, const char *valid)
{
    try {
        return given.cast<Number>();
    } catch (const py::cast_error &) {
        throw py::type_error("read: " + name + " = " + py::repr(given).cast<std::string>() + ": valid are " + valid);
    }
}

// Three numbers, NaN where one is not measured; returns their valid bits.
static uint32_t numbers_of(const py::object &reading, const char *name, double (&numbers)[NT_AXES])
{
    const py::object given = reading.attr(name);
    if (!PySequence_Check(given.ptr()) || py::len(given) != NT_AXES)
        throw py::type_error(std::string("read: ") + name + " must be three numbers, not " +
                             py::repr(given).cast<std::string>());
    uint32_t valid = 0;
    for (int i = 0; i < NT_AXES; ++i) {
        numbers[i] = number_of<double>(given[py::int_(i)], name, "numbers, NaN where nothing is measured");
        valid |= std::isnan(numbers[i]) ? 0u : 1u << i;
    }
    return valid;
}

static uint32_t flags_of(const py::object &names)
{
    static constexpr const char *known[] = {"emergency_stop", "limit_switch", "invalid", "saturated", "device_lost"};
    uint32_t flags = 0;
    for (const py::handle item : names) {
        const auto name = item.cast<std::string>();
        uint32_t bit = 0;
        for (int i = 0; i < 5; ++i)
            bit |= name == known[i] ? 1u << i : 0u;
        if (bit == 0)
            throw py::value_error("read: no flag '" + name +
                                  "': valid are emergency_stop, limit_switch, invalid, saturated, device_lost");
        flags |= bit;
    }
    return flags;
}

// One number, NaN where it is not measured; returns its valid bit.
static uint32_t number_at(const py::object &reading, const char *name, int channel, double &number)
{
    number = number_of<double>(reading.attr(name), name, "numbers, NaN where nothing is measured");
    return std::isnan(number) ? 0u : 1u << channel;
}

void take_measured(const py::object &given, nt_reading &reading)
{
    reading.valid = numbers_of(given, "position", reading.position) << NT_READS_POSITION;
    reading.valid |= numbers_of(given, "felt", reading.felt) << NT_READS_FELT;
    reading.valid |= number_at(given, "amplitude", NT_READS_AMPLITUDE, reading.amplitude);
    reading.valid |= number_at(given, "lag", NT_READS_LAG, reading.lag);
    reading.flags = flags_of(given.attr("flags"));
    reading.buttons = number_of<uint32_t>(given.attr("buttons"), "buttons", "whole numbers, 0 .. 2^32 - 1");
}

int64_t time_of(const py::object &given)
{
    return number_of<int64_t>(given, "time", "whole nanoseconds, -2^63 .. 2^63 - 1");
}

static void fill(PythonHalf &half, const py::object &found, nt_reading &reading)
{
    if (!py::isinstance(found, half.reading_type))
        throw py::type_error("read: it must return a nanotouch.hal.Reading or None, not " +
                             py::repr(found).cast<std::string>());
    nt_reading made{};
    made.size = reading.size;
    take_measured(found, made);
    const py::object number = found.attr("sequence"), time = found.attr("time");
    if (!number.is_none() && (!PyLong_Check(number.ptr()) || number < py::int_(0)))
        throw py::value_error("read: sequence = " + py::repr(number).cast<std::string>() +
                              ": valid are whole numbers from 0 up");
    made.sequence = half.sequence =
        number.is_none() ? half.sequence + 1u : number_of<uint64_t>(number, "sequence", "whole numbers, 0 .. 2^64 - 1");
    made.time = time.is_none() ? half.host->get().now(half.host->host) : time_of(time);
    reading = made;
}

static nt_status read_python(void *context, nt_reading *reading)
{
    return guarded(context, [reading](PythonHalf &half) {
        const py::object found = half.self.attr("read")();
        if (!found.is_none())
            fill(half, found, *reading);
    });
}

static nt_status write_python(void *context, const nt_action *action)
{
    return guarded(context, [action](PythonHalf &half) {
        half.self.attr("write")(
            half.action_type(action->tick, action->time, half.states[py::int_(action->state)],
                             py::make_tuple(action->target[0], action->target[1], action->target[2]),
                             action->drive_amplitude, action->drive_frequency));
    });
}

static void disarm_python(void *context)
{
    (void)guarded(context, [](PythonHalf &half) { half.self.attr("disarm")(); });
}

static void close_python(void *context)
{
    (void)guarded(context, [](PythonHalf &half) { half.self.attr("close")(); });
    static_cast<PythonHalf *>(context)->host->host = nullptr;
}

PythonHalf::PythonHalf(py::object given, nt_half half)
    : self(std::move(given)), reading_type(hal_name("Reading")), action_type(hal_name("Action")),
      states(py::module_::import("nanotouch.touch.columns").attr("STATES")),
      name(py::type::of(self).attr("__name__").cast<std::string>())
{
    backend = {sizeof backend,  NT_HAL_API_VERSION, name.c_str(), half,        open_python,
               describe_python, configure_python,   arm_python,   read_python, write_python,
               disarm_python,   close_python,       nullptr};
    choice = {&backend, this};
    option = self.attr("option").cast<std::string>();
}

std::shared_ptr<Half> half_of(const py::object &given, nt_half half)
{
    static constexpr const char *names[] = {"master", "slave"};
    if (given.is_none())
        return nullptr;
    if (py::isinstance(given, hal_name("SharedObject")))
        return std::make_shared<ModuleHalf>(given, half);
    if (py::isinstance(given, py::module_::import("nanotouch.touch.rig_file").attr("Converters")))
        return converter_half_of(given, half);
    if (py::isinstance(given, hal_name("Mailbox")))
        return mailbox_half_of(given, half);
    if (py::isinstance(given, hal_name("Replay")))
        return replay_half_of(given, half);
    if (py::isinstance(given, hal_name(half == NT_HALF_MASTER ? "Master" : "Slave")))
        return std::make_shared<PythonHalf>(given, half);
    throw py::type_error(std::string(names[half]) + ": " + py::repr(given).cast<std::string>() +
                         " is neither a nanotouch.hal." + (half == NT_HALF_MASTER ? "Master" : "Slave") +
                         ", a nanotouch.hal.SharedObject, a Mailbox nor a Replay");
}

// --- the rehearsal ---

using Clock = std::chrono::steady_clock;

// Its clock, that of the machine or one that only passes with the periods, and what the backend has said.
struct Stage {
    bool real;
    int64_t time; // [ns]
    std::vector<std::string> said;
};

static Stage &stage_of(const nt_host *host)
{
    return *static_cast<Stage *>(host->context);
}

static int64_t stage_now(const nt_host *host)
{
    const auto now = std::chrono::duration_cast<std::chrono::nanoseconds>(Clock::now().time_since_epoch());
    return stage_of(host).real ? now.count() : stage_of(host).time;
}

static void stage_pass(const nt_host *host, double period)
{
    if (stage_of(host).real)
        std::this_thread::sleep_for(std::chrono::duration<double>(period));
    stage_of(host).time += std::llround(1e9 * period);
}

static void stage_say(const nt_host *host, const char *text)
{
    stage_of(host).said.emplace_back(text ? text : "(no text)");
}

static void raise_rehearsed(nt_status status, const nt_problem &problem, const std::string &what)
{
    const bool is_operation = problem.unit && std::string(problem.unit) == "nt_status";
    if (is_operation)
        raise_on(status, what + ": " + problem.field);
    raise_on(status, problem, what);
}

static py::tuple rehearse(const py::object &given, bool is_master, double period, long periods, bool real, double move)
{
    const nt_half half = is_master ? NT_HALF_MASTER : NT_HALF_SLAVE;
    const std::shared_ptr<Half> made = half_of(given, half);
    if (!made)
        throw py::type_error("rehearse: None is neither a nanotouch.hal.Master, a Slave, a SharedObject nor a Mailbox");
    Stage stage{real, 0, {}};
    const nt_host host = {sizeof host, NT_HAL_API_VERSION, stage_now, stage_say, &stage};
    const nt_configuration configuration = {sizeof configuration, 0, period, 1e-6, made->option.c_str()};
    const nt_rehearsal rehearsal = {half, made->choice, &host, configuration, periods, stage_pass, move};
    nt_rehearsed seen{};
    nt_problem problem{};
    nt_status status;
    {
        const py::gil_scoped_release release;
        status = nt_hal_rehearse(&rehearsal, &seen, &problem);
    }
    made->rethrow();
    raise_rehearsed(status, problem,
                    std::string("rehearsal of ") +
                        (made->choice.backend->name ? made->choice.backend->name : "a backend"));
    py::list said;
    for (const std::string &line : stage.said)
        said.append(text_of(line.c_str()));
    return py::make_tuple(seen.readings, seen.oldest, said, seen.same, seen.moved,
                          (seen.capabilities.can & NT_CAN_FEEL) != 0, (seen.capabilities.can & NT_CAN_PUSH) != 0,
                          seen.capabilities.axes);
}

void bind_hal(py::module_ &module)
{
    bind_converters(module);
    bind_mailbox(module);
    py::class_<Host, std::shared_ptr<Host>>(module, "Host")
        .def("now", [](const Host &self) { return self.get().now(&self.get()); })
        .def("say", [](const Host &self, const std::string &text) { self.get().say(&self.get(), text.c_str()); });
    module.def("rehearse", &rehearse);
}
