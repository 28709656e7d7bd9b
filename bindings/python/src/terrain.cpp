// SPDX-License-Identifier: BSD-3-Clause
// terrain.h
#include <array>
#include <memory>
#include <optional>

#include "descriptions.h"
#include "internal/terrain.h"
#include "surface.h"

static std::unique_ptr<Terrain> make(const Described<nt_scene> &scene, const Described<nt_demand> &demand,
                                     const Described<nt_rig> *rig, std::shared_ptr<Surface> surface,
                                     std::shared_ptr<RadiusMap> radii, std::shared_ptr<Properties> properties)
{
    nt_terrain_setup setup = nt_terrain_defaults();
    setup.scene = scene.value;
    setup.demand = demand.value;
    setup.probe = rig ? &rig->value.probe : nullptr;
    setup.surface = surface ? &surface->surface : nullptr;
    setup.radii = radii ? &radii->map : nullptr;
    setup.properties = properties ? &properties->properties : nullptr;
    nt_terrain *made = nullptr;
    nt_problem problem{};
    nt_status status;
    {
        py::gil_scoped_release release;
        status = nt_terrain_make(&made, &setup, &problem);
    }
    raise_on(status, problem, "plan");
    auto terrain = std::make_unique<Terrain>();
    *terrain = {std::move(surface), std::move(radii), std::move(properties),
                std::shared_ptr<nt_terrain>(made, nt_terrain_close)};
    return terrain;
}

static std::unique_ptr<nt_plan> plan_of(const Terrain &self)
{
    auto copy = std::make_unique<nt_plan>();
    nt_plan_copy(copy.get(), nt_terrain_plan(self.made.get()));
    return copy;
}

// in the order of nt_reach
static py::tuple tuple_of(const nt_reach &reach)
{
    return py::make_tuple(reach.rise, reach.relief, reach.slope, reach.least_radius, reach.largest_radius,
                          reach.least_modulus, reach.largest_modulus, reach.least_work, reach.largest_work);
}

static py::tuple reach_path(const Terrain &self, const Array &points)
{
    if (points.ndim() != 2 || points.shape(1) != 2)
        throw py::value_error("a path must be an array (n, 2)");
    const double *xy = points.data();
    const long count = static_cast<long>(points.shape(0));
    nt_reach reach{};
    nt_problem problem{};
    nt_status status;
    {
        py::gil_scoped_release release;
        status = nt_terrain_reach_path(self.made.get(), xy, count, &reach, &problem);
    }
    raise_on(status, problem, "reach");
    return tuple_of(reach);
}

// Of a rectangle (x_min, x_max, y_min, y_max), by default all of the terrain.
static py::tuple reach_area(const Terrain &self, double x, double y,
                            const std::optional<std::array<double, 4>> &rectangle)
{
    nt_area area = nt_terrain_whole(self.made.get(), x, y);
    if (rectangle)
        area = {x, y, (*rectangle)[0], (*rectangle)[1], (*rectangle)[2], (*rectangle)[3]};
    nt_reach reach{};
    nt_problem problem{};
    nt_status status;
    {
        py::gil_scoped_release release;
        status = nt_terrain_reach_area(self.made.get(), &area, &reach, &problem);
    }
    raise_on(status, problem, "reach");
    return tuple_of(reach);
}

void bind_terrain(py::module_ &module)
{
    py::class_<Terrain>(module, "Terrain")
        .def(py::init(&make), py::arg("scene"), py::arg("demand"), py::arg("rig"), py::arg("surface"), py::arg("radii"),
             py::arg("properties"))
        .def_property_readonly("plan", py::cpp_function(&plan_of, py::keep_alive<0, 1>())) // it borrows all the rest
        .def("reach_path", &reach_path, py::arg("points"))
        .def("reach_area", &reach_area, py::arg("x"), py::arg("y"), py::arg("rectangle") = py::none());
}
