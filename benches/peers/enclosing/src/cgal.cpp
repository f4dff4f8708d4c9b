// CGAL's Min_sphere_of_spheres_d in double behind C functions: center and radius of the minimal sphere of n spheres,
// each given as x, y, z, radius. The copy of the input that CGAL's interface asks for is part of what is timed.

#include <CGAL/Min_sphere_of_spheres_d.h>
#include <CGAL/Min_sphere_of_spheres_d_traits_3.h>
#include <CGAL/Simple_cartesian.h>

#include <cstddef>
#include <iterator>

namespace {

using Kernel = CGAL::Simple_cartesian<double>;

// Walks over quadruples of doubles as CGAL's pairs of a point and a radius.
template <class Sphere> struct Walk {
    using iterator_category = std::forward_iterator_tag;
    using value_type = Sphere;
    using difference_type = std::ptrdiff_t;
    using pointer = const Sphere *;
    using reference = Sphere;
    const double *at;
    Sphere operator*() const { return Sphere(typename Sphere::first_type(at[0], at[1], at[2]), at[3]); }
    Walk &operator++() {
        at += 4;
        return *this;
    }
    Walk operator++(int) {
        Walk old = *this;
        at += 4;
        return old;
    }
    bool operator==(const Walk &other) const { return at == other.at; }
    bool operator!=(const Walk &other) const { return at != other.at; }
};

template <class Use_square_roots, class Algorithm>
void enclosing(const double *spheres, std::size_t n, double *out) {
    using Traits = CGAL::Min_sphere_of_spheres_d_traits_3<Kernel, double, Use_square_roots, Algorithm>;
    using Sphere = typename Traits::Sphere;
    CGAL::Min_sphere_of_spheres_d<Traits> minimal(Walk<Sphere>{spheres}, Walk<Sphere>{spheres + 4 * n});
    const double *center = minimal.center_cartesian_begin();
    for (int axis = 0; axis < 3; ++axis) out[axis] = center[axis];
    out[3] = minimal.radius();
}

}  // namespace

extern "C" void cgal_farthest_first(const double *spheres, std::size_t n, double *out) {
    enclosing<CGAL::Tag_true, CGAL::Farthest_first_heuristic>(spheres, n, out);
}

extern "C" void cgal_farthest_first_no_roots(const double *spheres, std::size_t n, double *out) {
    enclosing<CGAL::Tag_false, CGAL::Farthest_first_heuristic>(spheres, n, out);
}
