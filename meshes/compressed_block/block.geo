// The block of parameter_files/compressed_block.prm: 20 x 10 cm, 32 x 32 quadrilaterals.
// Made by: gmsh -2 -format msh22 block.geo -o block.msh
Point(1) = {10, 15, 0};
Point(2) = {30, 15, 0};
Point(3) = {30, 25, 0};
Point(4) = {10, 25, 0};
Line(1) = {1, 2};
Line(2) = {2, 3};
Line(3) = {3, 4};
Line(4) = {4, 1};
Curve Loop(1) = {1, 2, 3, 4};
Plane Surface(1) = {1};
Transfinite Curve {1, 2, 3, 4} = 33;
Transfinite Surface {1};
Recombine Surface {1};
Physical Surface("block", 1) = {1};
