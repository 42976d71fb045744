// The cross-section of the cylinder of the DFG benchmark: a disc of diameter 0.1 cm at
// (0.2, 0.2) cm. Made by: gmsh -2 -format msh22 disc.geo -o disc.msh
r      = 0.05;
DefineConstant[ rim = 0.0025 ]; // size of the elements at the surface and in the middle [cm]
middle = 0.008;
Point(1) = {0.2, 0.2, 0, middle};
Point(2) = {0.2 + r, 0.2, 0, rim};
Point(3) = {0.2, 0.2 + r, 0, rim};
Point(4) = {0.2 - r, 0.2, 0, rim};
Point(5) = {0.2, 0.2 - r, 0, rim};
Circle(1) = {2, 1, 3};
Circle(2) = {3, 1, 4};
Circle(3) = {4, 1, 5};
Circle(4) = {5, 1, 2};
Curve Loop(1) = {1, 2, 3, 4};
Plane Surface(1) = {1};
Point{1} In Surface{1};
Physical Surface("cylinder", 1) = {1};
