"""sensor_msgs_py.numpy_compat: there numpy's functions for versions that lack them; here numpy's own."""

from numpy.lib.recfunctions import structured_to_unstructured as structured_to_unstructured
from numpy.lib.recfunctions import unstructured_to_structured as unstructured_to_structured
