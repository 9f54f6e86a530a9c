"""The names of the node and of its package, for those who must not load MuJoCo."""

NAME = "lynxmotion_al5d"
PACKAGE = "lynxmotion_al5d_description"
