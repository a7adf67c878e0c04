"""Pages and pictures, tested by what can be seen on them."""
