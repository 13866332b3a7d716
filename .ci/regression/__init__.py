"""What the program computes, recorded and compared: see values.py beside this folder."""
