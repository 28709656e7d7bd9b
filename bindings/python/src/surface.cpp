// SPDX-License-Identifier: BSD-3-Clause
// surface.h
#include "surface.h"
#include "internal/surface.h"

#include <optional>

static nt_height_map map_of(const Array &heights, double dy, double dx)
{
    if (heights.ndim() != 2)
        throw py::value_error("heights must be a 2-D array (ny, nx)");
    const nt_height_map map = {heights.data(), static_cast<long>(heights.shape(1)), static_cast<long>(heights.shape(0)),
                               dx, dy};
    nt_problem problem{};
    raise_on(nt_height_map_check(&map, &problem), problem, "surface");
    return map;
}

static py::array_t<double> dilate(const Array &heights, double dy, double dx, double radius, double half_angle)
{
    const nt_height_map map = map_of(heights, dy, dx);
    const nt_tip_shape tip = {radius, half_angle};
    py::array_t<double> dilated({heights.shape(0), heights.shape(1)});
    double *out = dilated.mutable_data();
    nt_status status;
    {
        py::gil_scoped_release release;
        status = nt_surface_dilate(&map, &tip, out);
    }
    raise_on(status, "tip dilation");
    return dilated;
}

// With `overwrite` the coefficients take the memory of the heights, and no copy is made.
static std::shared_ptr<Surface> make(const Array &heights, double dy, double dx, bool overwrite)
{
    const nt_height_map map = map_of(heights, dy, dx);
    auto made = std::make_shared<Surface>();
    made->coefficients = overwrite ? heights : Array({heights.shape(0), heights.shape(1)});
    double *coefficients = made->coefficients.mutable_data(); // an exception where the array is read-only
    nt_status status;
    {
        py::gil_scoped_release release;
        status = nt_surface_init(&made->surface, &map, coefficients);
    }
    raise_on(status, "surface");
    return made;
}

static py::array_t<double> heights_at(const Surface &self, const Array &x, const Array &y)
{
    if (x.size() != y.size())
        throw py::value_error("x and y must have the same shape");
    py::array_t<double> out(std::vector<py::ssize_t>(x.shape(), x.shape() + x.ndim()));
    const double *xs = x.data(), *ys = y.data();
    double *z = out.mutable_data();
    const py::ssize_t count = x.size();
    {
        py::gil_scoped_release release;
        for (py::ssize_t i = 0; i < count; ++i)
            z[i] = nt_surface_height(&self.surface, xs[i], ys[i]).z;
    }
    return out;
}

static std::shared_ptr<RadiusMap> make_radius_map(const Surface &surface, double tip_radius, double minimum,
                                                  double maximum)
{
    const nt_radius_limits limits = {minimum, maximum};
    auto made = std::make_shared<RadiusMap>();
    made->coefficients = Array({surface.surface.ny, surface.surface.nx});
    double *coefficients = made->coefficients.mutable_data();
    nt_status status;
    {
        py::gil_scoped_release release;
        status = nt_radius_map_init(&made->map, &surface.surface, tip_radius, &limits, coefficients);
    }
    raise_on(status, "radius map");
    return made;
}

// {R, dR/dx, dR/dy}
static py::tuple radii_at(const RadiusMap &self, const Array &x, const Array &y)
{
    if (x.size() != y.size())
        throw py::value_error("x and y must have the same shape");
    const std::vector<py::ssize_t> shape(x.shape(), x.shape() + x.ndim());
    py::array_t<double> radius(shape), dx(shape), dy(shape);
    double *out[3] = {radius.mutable_data(), dx.mutable_data(), dy.mutable_data()};
    const double *xs = x.data(), *ys = y.data();
    const py::ssize_t count = x.size();
    {
        py::gil_scoped_release release;
        for (py::ssize_t i = 0; i < count; ++i) {
            const nt_radius_value at = nt_radius_map_eval(&self.map, xs[i], ys[i]);
            out[0][i] = at.radius;
            out[1][i] = at.dx;
            out[2][i] = at.dy;
        }
    }
    return py::make_tuple(radius, dx, dy);
}

static std::shared_ptr<Properties> make_properties(const Surface &surface, const std::optional<Array> &youngs_modulus,
                                                   const std::optional<Array> &work_of_adhesion)
{
    auto made = std::make_shared<Properties>();
    const std::optional<Array> *given[2] = {&youngs_modulus, &work_of_adhesion};
    const double *values[2] = {nullptr, nullptr};
    for (int i = 0; i < 2; ++i)
        if (*given[i]) {
            const Array &array = **given[i];
            if (array.ndim() != 2 || array.shape(0) != surface.surface.ny || array.shape(1) != surface.surface.nx)
                throw py::value_error("properties must have the shape of the surface");
            made->values[i] = array;
            values[i] = array.data();
        }
    nt_problem problem{};
    raise_on(nt_properties_init(&made->properties, &surface.surface, values[0], values[1], &problem), problem,
             "surface");
    return made;
}

// {E_s, w}, 0 where there is none
static py::tuple properties_at(const Properties &self, const Surface &surface, const Array &x, const Array &y)
{
    if (x.size() != y.size())
        throw py::value_error("x and y must have the same shape");
    const std::vector<py::ssize_t> shape(x.shape(), x.shape() + x.ndim());
    py::array_t<double> modulus(shape), work(shape);
    double *out[2] = {modulus.mutable_data(), work.mutable_data()};
    const double *xs = x.data(), *ys = y.data();
    const py::ssize_t count = x.size();
    {
        py::gil_scoped_release release;
        for (py::ssize_t i = 0; i < count; ++i) {
            const nt_place place = nt_surface_place(&surface.surface, nullptr, &self.properties, xs[i], ys[i]);
            out[0][i] = place.youngs_modulus.value;
            out[1][i] = place.work_of_adhesion.value;
        }
    }
    return py::make_tuple(modulus, work);
}

static py::array_t<double> sample(double (*height)(const void *, double, double), const void *what, long ny, long nx,
                                  double dy, double dx)
{
    py::array_t<double> out({static_cast<py::ssize_t>(ny), static_cast<py::ssize_t>(nx)});
    double *z = out.mutable_data();
    for (long j = 0; j < ny; ++j)
        for (long i = 0; i < nx; ++i)
            z[j * nx + i] = height(what, static_cast<double>(i) * dx, static_cast<double>(j) * dy);
    return out;
}

void bind_surface(py::module_ &module)
{
    py::class_<Surface, std::shared_ptr<Surface>>(module, "Surface")
        .def(py::init(&make), py::arg("heights"), py::arg("dy"), py::arg("dx"), py::arg("overwrite") = false)
        .def("heights", &heights_at, py::arg("x"), py::arg("y"));
    py::class_<RadiusMap, std::shared_ptr<RadiusMap>>(module, "RadiusMap")
        .def(py::init(&make_radius_map), py::arg("surface"), py::arg("tip_radius"), py::arg("minimum"),
             py::arg("maximum"))
        .def("radii", &radii_at, py::arg("x"), py::arg("y"))
        .def_property_readonly("minimum", [](const RadiusMap &self) { return self.map.minimum; })
        .def_property_readonly("maximum", [](const RadiusMap &self) { return self.map.maximum; })
        .def_property_readonly("limited", [](const RadiusMap &self) { return self.map.limited; });
    py::class_<Properties, std::shared_ptr<Properties>>(module, "Properties")
        .def(py::init(&make_properties), py::arg("surface"), py::arg("youngs_modulus"), py::arg("work_of_adhesion"))
        .def("at", &properties_at, py::arg("surface"), py::arg("x"), py::arg("y"));
    module.def("dilate", &dilate);
    module.def("grating",
               [](long ny, long nx, double dy, double dx, double period, double height, double duty, double offset) {
                   const nt_grating grating = {period, height, duty, offset};
                   auto at = [](const void *g, double x, double y) {
                       return nt_grating_height(static_cast<const nt_grating *>(g), x, y);
                   };
                   return sample(at, &grating, ny, nx, dy, dx);
               });
    module.def("dots", [](long ny, long nx, double dy, double dx, int count, double width, uint64_t seed) {
        nt_dots dots;
        raise_on(nt_dots_scatter(&dots, count, width, seed), "quantum dots");
        auto at = [](const void *d, double x, double y) {
            return nt_dots_height(static_cast<const nt_dots *>(d), x, y);
        };
        return sample(at, &dots, ny, nx, dy, dx);
    });
}
