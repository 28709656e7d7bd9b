// SPDX-License-Identifier: BSD-3-Clause
// mailbox.h: a half in another process, both ends
#include "nanotouch/mailbox.h"

#include <cmath>

#include "hal.h"

// --- the session's end ---

struct MailboxHalf : Half {
    nt_mailbox_half half{};

    MailboxHalf(const std::string &name, nt_half which)
    {
        raise_on(nt_mailbox_half_init(&half, name.c_str()), "mailbox '" + name + "'");
        choice = {nt_mailbox_backend(which), &half};
    }
};

std::shared_ptr<Half> mailbox_half_of(const py::object &given, nt_half half)
{
    return std::make_shared<MailboxHalf>(given.attr("name").cast<std::string>(), half);
}

// --- the program's end ---

struct Mailbox {
    nt_mailbox *mailbox = nullptr;

    Mailbox(const std::string &name, bool is_master, const py::object &capabilities, double timeout)
    {
        Rows rows;
        rows.take(capabilities.attr("channels").cast<py::list>());
        nt_mailbox_device device = nt_mailbox_device_defaults(is_master ? NT_HALF_MASTER : NT_HALF_SLAVE);
        device.can = can_of(capabilities);
        device.axes = capabilities.attr("axes").cast<int>();
        device.period = capabilities.attr("period").cast<double>();
        device.rows = static_cast<int>(rows.rows.size());
        device.channels = rows.rows.data();
        device.timeout = timeout;
        nt_problem problem{};
        const nt_status status = nt_mailbox_open(&mailbox, name.c_str(), &device, &problem);
        if (status == NT_E_STATE)
            raise(status, "mailbox '" + name + "': another program serves it, or another user");
        raise_on(status, problem, "mailbox '" + name + "'");
    }
    Mailbox(const Mailbox &) = delete;
    Mailbox &operator=(const Mailbox &) = delete;
    ~Mailbox()
    {
        close();
    }
    nt_mailbox *get() const
    {
        if (!mailbox)
            throw py::value_error("this mailbox is closed");
        return mailbox;
    }
    void publish(const py::object &given) const
    {
        nt_reading reading{};
        take_measured(given, reading);
        const py::object time = given.attr("time");
        reading.time = time.is_none() ? nt_mailbox_now(get()) : time_of(time);
        if (nt_mailbox_publish(get(), &reading) != NT_OK)
            raise(NT_E_RANGE, "publish: " + py::repr(given).cast<std::string>() +
                                  " cannot be a reading of this device: an axis or a force that it does not have, an "
                                  "infinite number, a lost device that measures, or a time in the future");
    }
    py::tuple ask() const
    {
        nt_mailbox_request request;
        nt_mailbox_ask(get(), &request);
        return py::make_tuple(request.is_armed != 0, request.state, request.tick, request.time,
                              py::make_tuple(request.target[0], request.target[1], request.target[2]), request.lift,
                              request.drive_amplitude, request.drive_frequency);
    }
    void close()
    {
        nt_mailbox_close(mailbox);
        mailbox = nullptr;
    }
};

void bind_mailbox(py::module_ &core)
{
    py::class_<Mailbox>(core.attr("rigs"), "Mailbox")
        .def(py::init<const std::string &, bool, const py::object &, double>())
        .def("publish", &Mailbox::publish)
        .def("beat", [](const Mailbox &self) { nt_mailbox_beat(self.get()); })
        .def("ask", &Mailbox::ask)
        .def("now", [](const Mailbox &self) { return nt_mailbox_now(self.get()); })
        .def("close", &Mailbox::close);
}
