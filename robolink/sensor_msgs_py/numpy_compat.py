"""Module sensor_msgs_py.numpy_compat: numpy's own functions (upstream has copies for versions that lack them)."""

from numpy.lib.recfunctions import structured_to_unstructured as structured_to_unstructured
from numpy.lib.recfunctions import unstructured_to_structured as unstructured_to_structured
