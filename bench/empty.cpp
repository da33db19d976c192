// The least program: its run is the loader's time for what it is linked to.
int main() {}
