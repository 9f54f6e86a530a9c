"""Pictures of a world, without a screen: stills as PNG, runs as GIF, and what a robot's camera would show.

======================  =============================================================================================
``views``               a camera: where it is, where it looks, how much it sees
``solids``              the shapes of a world, and where a ray meets each kind of them
``triangles``           where rays meet the triangles of meshes
``drawing``             the picture: which shape each pixel shows, how far it is, its colour
``stills``              pictures as files
``movies``              a run as an animation
======================  =============================================================================================

MuJoCo's own renderer needs OpenGL with a window system, EGL or OSMesa, and two more packages; a server, a container and CI often have none
of them. The shapes of a world are boxes, cylinders, spheres and meshes, and a ray meets these in closed form, so numpy draws them exactly,
in some tenths of a second. The same pixels come on each machine. Files are written
by Pillow, which cramhy needs for the turtle's pictures already.
"""
