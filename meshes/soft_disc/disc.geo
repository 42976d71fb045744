// A disc of radius 0.2 cm at (0.6, 0.5) cm, quadratic triangles. Made by:
// gmsh -2 -order 2 -format msh22 disc.geo -o disc.msh
r      = 0.2;
DefineConstant[ size = 0.03125 ]; // of the elements [cm]: two cells of a grid with 64 a side
Point(1) = {0.6, 0.5, 0, size};
Point(2) = {0.6 + r, 0.5, 0, size};
Point(3) = {0.6, 0.5 + r, 0, size};
Point(4) = {0.6 - r, 0.5, 0, size};
Point(5) = {0.6, 0.5 - r, 0, size};
Circle(1) = {2, 1, 3};
Circle(2) = {3, 1, 4};
Circle(3) = {4, 1, 5};
Circle(4) = {5, 1, 2};
Curve Loop(1) = {1, 2, 3, 4};
Plane Surface(1) = {1};
Point{1} In Surface{1};
Physical Surface("disc", 1) = {1};
