// SPDX-License-Identifier: BSD-3-Clause
// frames.h
#include <array>

#include "frames.h"

static uint64_t post_request(Client &self, uint32_t kind, uint32_t field, const std::array<double, 4> &value)
{
    nt_request request = {0, kind, field, {value[0], value[1], value[2], value[3]}};
    raise_on(nt_client_post(self.open(), &request), "request");
    return request.id;
}

static py::tuple poll_answer(const Client &self, uint64_t id)
{
    nt_answer answer;
    raise_on(nt_client_poll(self.open(), id, &answer), "answer");
    const char *message = nt_status_message(static_cast<nt_status>(answer.status));
    return py::make_tuple(answer.id, answer.tick, answer.status, answer.pending != 0, message);
}

void bind_commands(py::module_ &module)
{
    module.attr("request_stop") = NT_REQUEST_STOP;
    py::class_<Client>(module, "Client")
        .def(py::init([](const std::string &name) {
                 auto made = std::make_unique<Client>();
                 raise_on(nt_client_attach(&made->handle, name.c_str()), "session");
                 return made;
             }),
             py::arg("name"))
        .def("lease", [](Client &self) { raise_on(nt_client_lease(self.open()), "lease"); })
        .def("release", [](Client &self) { nt_client_release(self.open()); })
        .def("post", &post_request)
        .def("poll", &poll_answer)
        .def("close", &Client::close);
}
