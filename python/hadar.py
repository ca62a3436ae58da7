"""``import hadar`` for ``import hadar_limits as hadar``, where no other package has the name.

A module, not a folder: the package of that name on PyPI stands beside it, neither overwrites the other, and its folder is found first.
"""

import sys

import hadar_limits

sys.modules[__name__] = hadar_limits
