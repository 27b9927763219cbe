$$ expects L205 6:3
UNITS/MM
LOADTL/1,LENGTH,100
CUTTER/10
FEDRAT/100,MMPM
A/(A/(A/(A/(A/(A/(A/(A/(A/(A/(A/(A/(A/(A/(A/(A/(A/(A/(A/(A/(A/(A/1)))))))))))))))))))))
