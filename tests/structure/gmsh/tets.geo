SetFactory("OpenCASCADE");
Sphere(1)={0,0,0,1,0,Pi/2,Pi/2};
MeshSize{:}=0.9;
Physical Volume(1)={1};
