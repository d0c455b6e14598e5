"""What the pictures of a run have in common."""

TENSION_CRACK, SHEAR_CRACK = "#d7191c", "black"
DPI = 150
