"""Package tf_transformations of ROS 2: vectors, homogeneous matrices, quaternions and Euler angles.

Quaternions are x, y, z, w. Angles are radians. Matrices are 4x4 and act on columns. Vectors, matrices and quaternions
may be given as any sequences. `axes` says how three Euler angles are meant: see `robolink.geometry.rotations`.
"""

from robolink.geometry.matrices import (
    compose_matrix,
    concatenate_matrices,
    decompose_matrix,
    identity_matrix,
    inverse_matrix,
    is_same_transform,
    reflection_from_matrix,
    reflection_matrix,
    rotation_from_matrix,
    rotation_matrix,
    scale_from_matrix,
    scale_matrix,
    superimposition_matrix,
    translation_from_matrix,
    translation_matrix,
)
from robolink.geometry.rotations import _AXES2TUPLE as _AXES2TUPLE
from robolink.geometry.rotations import _TUPLE2AXES as _TUPLE2AXES
from robolink.geometry.rotations import (
    euler_from_matrix,
    euler_from_quaternion,
    euler_matrix,
    quaternion_about_axis,
    quaternion_conjugate,
    quaternion_from_euler,
    quaternion_from_matrix,
    quaternion_inverse,
    quaternion_matrix,
    quaternion_multiply,
    quaternion_slerp,
    random_quaternion,
    random_rotation_matrix,
    random_vector,
    unit_vector,
    vector_norm,
)

__all__ = [
    "compose_matrix",
    "concatenate_matrices",
    "decompose_matrix",
    "euler_from_matrix",
    "euler_from_quaternion",
    "euler_matrix",
    "identity_matrix",
    "inverse_matrix",
    "is_same_transform",
    "quaternion_about_axis",
    "quaternion_conjugate",
    "quaternion_from_euler",
    "quaternion_from_matrix",
    "quaternion_inverse",
    "quaternion_matrix",
    "quaternion_multiply",
    "quaternion_slerp",
    "random_quaternion",
    "random_rotation_matrix",
    "random_vector",
    "reflection_from_matrix",
    "reflection_matrix",
    "rotation_from_matrix",
    "rotation_matrix",
    "scale_from_matrix",
    "scale_matrix",
    "superimposition_matrix",
    "translation_from_matrix",
    "translation_matrix",
    "unit_vector",
    "vector_norm",
]
