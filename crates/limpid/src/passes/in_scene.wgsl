// Whether the frame has a scene's depth; without one, what hides liquid is left out of the kernels.
override IN_SCENE: bool = true;
