// The slope in 3858 triangles, as many as the paper has; it does not say how they lie. Here they are small as deep as the storm
// wets the ground, and grow below. Remade, with Gmsh 4.8.4, by
//   gmsh -2 -format msh41 slope_triangles.geo -o slope_triangles.msh
fine = 0.5744;  // m, down to `wet`; sets the number of triangles
coarse = 3;     // m, from `deep` down
wet = 5;        // m below the surface
deep = 20;      // m below the surface

Point(1) = {0, 0, 0};
Point(2) = {60, 0, 0};
Point(3) = {60, 10, 0};
Point(4) = {40, 10, 0};
Point(5) = {20, 30, 0};
Point(6) = {0, 30, 0};
Line(1) = {1, 2};
Line(2) = {2, 3};
Line(3) = {3, 4};
Line(4) = {4, 5};
Line(5) = {5, 6};
Line(6) = {6, 1};
Curve Loop(1) = {1:6};
Plane Surface(1) = {1};

Physical Curve("base") = {1};
Physical Curve("left") = {6};
Physical Curve("right") = {2};
Physical Curve("surface") = {3, 4, 5};
Physical Surface("soil") = {1};

Field[1] = Distance;
Field[1].CurvesList = {3, 4, 5};
Field[1].NNodesByEdge = 400;
Field[2] = Threshold;
Field[2].InField = 1;
Field[2].SizeMin = fine;
Field[2].SizeMax = coarse;
Field[2].DistMin = wet;
Field[2].DistMax = deep;
Background Field = 2;
Mesh.MeshSizeExtendFromBoundary = 0;
Mesh.MeshSizeFromPoints = 0;
Mesh.Algorithm = 6;  // frontal Delaunay
