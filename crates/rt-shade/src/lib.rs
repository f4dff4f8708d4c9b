//! Phong shading and texture mapping. Knows no shapes.
