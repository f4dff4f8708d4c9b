//! Compiles the CGAL shim for this machine.

fn main() {
    println!("cargo::rerun-if-changed=src/cgal.cpp");
    cc::Build::new()
        .cpp(true)
        .file("src/cgal.cpp")
        .flag("-std=c++17")
        .flag("-O3")
        .flag("-march=native")
        .define("NDEBUG", None)
        .warnings(false)
        .compile("cgal_shim");
}
